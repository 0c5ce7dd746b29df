#include "tests/stress/caller.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include "device/shrc203/stage.h"

namespace axisgate::stress {
namespace {

using namespace stage;

struct KnownAnswer {
  std::string question;
  std::string answer;
};

KnownAnswer known_answer(std::size_t device, int which) {
  const int axis = which % 3 + 1;
  switch (which / 3) {
    case 0:
      return {fmt::format("?:P{}", axis), std::to_string(nm_per_pulse(device, axis))};
    case 1:
      return {fmt::format("?:D{}", axis), fmt::format("S1000F{}R100", maximum_speed(device, axis))};
    case 2:
      return {"?:SN", serial_number(device)};
    default:
      return {"*IDN?", fmt::format("SIGMAKOKI,SHRC-203,{},{}", serial_number(device), firmware(device))};
  }
}
constexpr int kKnownAnswers = 10;

// Expects a problem that a lost line, a full queue or another caller's stop can cause.
void expect_excuse(const Problem& problem, const std::string& asked) {
  static const std::set<Reason> kExcuses = {
      Reason::link_down,        Reason::not_sent,       Reason::reply_timed_out, Reason::line_fault,
      Reason::axis_busy,        Reason::stopped,        Reason::deadline_passed, Reason::completion_outstanding,
      Reason::queue_full,       Reason::not_found,      Reason::outcome_unknown, Reason::target_not_reached,
      Reason::position_unknown, Reason::stale_setpoint, Reason::stopped_by,      Reason::stop_unconfirmed,
      Reason::too_fast};  // a path, if the load of the machine makes every answer late
  EXPECT_TRUE(kExcuses.contains(problem.reason)) << asked << ": " << name(problem.reason) << ": " << problem.message;
}

}  // namespace

void Caller::ask(int requests, std::size_t window) {
  for (int i = 0; i < requests; ++i) {
    const auto device = static_cast<std::size_t>(draw(0, kDevices - 1));
    // One request in eight is sent without waiting for the device to be up.
    if (draw(0, 7) != 0) {
      ASSERT_TRUE(bench_.wait_until_link(device, true)) << device_name(device) << " stays down";
    }
    request(device);
    ASSERT_TRUE(ledger_.wait_until_open(window - 1)) << "nobody answers";
  }
}

void Caller::rearm(std::size_t device) {
  server::Stage& there = bench_.device(device);
  there.post(
      [&there, who = name()](stage::StageController&, TimePoint now) { (void)there.leases().rearm(0, who, now); });
}

void Caller::flood(int requests) {
  for (int i = 0; i < requests; ++i) request(static_cast<std::size_t>(draw(0, kDevices - 1)));
}

void Caller::request(std::size_t device) {
  if (draw(0, 1) == 0) rearm(device);  // other callers may have stopped the axes of this caller
  const int kind = draw(0, 99);
  if (kind < 45) return question(device);
  if (kind < 55) return transaction(device);
  if (kind < 65) return refresh(device);
  if (kind < 85) return move(device);
  if (kind < 88) return path(device);
  if (kind < 90) return home(device);
  if (kind < 96) return set_and_go(device);
  if (kind < 98) return cancel(device);
  stop(device);
}

Caller::Ticket Caller::ticket(std::size_t device, const std::string& what) {
  return ledger_.issue(
      fmt::format("caller {} to {}, request {}: {}", number_, device_name(device), ledger_.issued(), what));
}

// Returns a context whose request id names the request, so that a motion that is reported to the wrong caller is
// detected.
use::RequestContext Caller::context(const Ticket& ticket) const { return {name(), ticket->asked(), {}}; }

void Caller::question(std::size_t device) {
  auto [line, answer] = known_answer(device, draw(0, kKnownAnswers - 1));
  execute(device, {std::move(line)}, {std::move(answer)});
}

void Caller::transaction(std::size_t device) {
  std::vector<std::string> lines, right;
  for (int i = 0; i < 3; ++i) {
    auto [line, answer] = known_answer(device, draw(0, kKnownAnswers - 1));
    lines.push_back(std::move(line));
    right.push_back(std::move(answer));
  }
  execute(device, std::move(lines), std::move(right));
}

void Caller::set_and_go(std::size_t device) {
  const int axis = draw(1, shrc203::kAxisCount);
  execute(device, {fmt::format("M:{}+P100", axis), fmt::format("G:{}", axis)}, {"OK", "OK"});
}

void Caller::execute(std::size_t device, std::vector<std::string> lines, std::vector<std::string> right) {
  const auto asked = ticket(device, fmt::format("{}", fmt::join(lines, " ")));
  auto heard = [this, asked, right = std::move(right), next = std::size_t{0}](const ExecuteEvent& event) mutable {
    switch (event.kind) {
      case ExecuteEvent::Kind::reply:
        ASSERT_LT(next, right.size()) << asked->asked() << ": " << event.answer;
        EXPECT_EQ(event.line, next) << asked->asked();
        // A setting or a start may be refused while a motion or a stop of another caller is in progress.
        if (right[next] != "OK" || event.answer != "NG") {
          EXPECT_EQ(event.answer, right[next]) << asked->asked();
        }
        ++right_answers_;
        ++next;
        return;
      case ExecuteEvent::Kind::motion:
        EXPECT_EQ(next, 0U) << asked->asked();
        return;
      case ExecuteEvent::Kind::completion:
        EXPECT_EQ(right.front(), "OK") << asked->asked() << " moved axis " << event.axis;
        return;
      case ExecuteEvent::Kind::ended:
        if (event.problem) {
          expect_excuse(*event.problem, asked->asked());
        } else {
          EXPECT_EQ(next, right.size()) << asked->asked() << " has answers left";
        }
        asked->answered();
    }
  };
  ExecuteRequest request{std::move(lines), context(asked)};
  bench_.device(device).post(
      [request = std::move(request), heard = std::move(heard)](StageController& controller, TimePoint now) {
        controller.execute(request, now, heard);
      });
}

void Caller::refresh(std::size_t device) {
  const auto asked = ticket(device, "the state");
  auto heard = [this, asked, device](Result<State> state) {
    if (state) {
      EXPECT_EQ(state->serial_number, serial_number(device)) << asked->asked();
      ++right_answers_;
    } else {
      expect_excuse(state.error(), asked->asked());
    }
    asked->answered();
  };
  bench_.device(device).post(
      [context = context(asked), heard = std::move(heard)](StageController& controller, TimePoint now) {
        controller.refresh({}, context, now, heard);
      });
}

StageController::OnStarted Caller::on_started(const Ticket& asked, std::size_t device) {
  return [this, asked, device](Result<Motion> motion) {
    if (motion) {
      EXPECT_EQ(motion->request_id, asked->asked());
      ++motions_started_;
      newest_motion_[device] = motion->id;
    } else {
      expect_excuse(motion.error(), asked->asked());
    }
    asked->answered();
  };
}

void Caller::move(std::size_t device) {
  const auto asked = ticket(device, "a move");
  MoveRequest request;
  request.context = context(asked);
  // A stop may leave a stale setpoint of either kind; the next setpoint of the same kind overwrites it.
  request.relative = draw(0, 1) == 0;
  request.moves.push_back({draw(1, shrc203::kAxisCount), pulses(draw(-3000, 3000)), {}});
  bench_.device(device).post(
      [request, started = on_started(asked, device)](StageController& controller, TimePoint now) {
        controller.move(request, now, started);
      });
}

void Caller::path(std::size_t device) {
  const auto asked = ticket(device, "a path");
  PathRequest request;
  request.context = context(asked);
  const int axis = draw(1, shrc203::kAxisCount);
  for (const int way : {500, -500, 500, -500}) request.segments.push_back({{{axis, pulses(way), {}}}, true, {}, {}});
  bench_.device(device).post(
      [request, started = on_started(asked, device)](StageController& controller, TimePoint now) {
        controller.run_path(request, now, started);
      });
}

void Caller::home(std::size_t device) {
  const auto asked = ticket(device, "an origin return");
  HomeRequest request{AxisSet::of(draw(1, shrc203::kAxisCount)), context(asked)};
  bench_.device(device).post(
      [request, started = on_started(asked, device)](StageController& controller, TimePoint now) {
        controller.home(request, now, started);
      });
}

void Caller::stop(std::size_t device) {
  const auto asked = ticket(device, "a stop");
  auto stopped = [asked](const StopReport& report) {
    if (report.problem) expect_excuse(*report.problem, asked->asked());
    asked->answered();
  };
  bench_.device(device).post([context = context(asked), stopped](StageController& controller, TimePoint now) {
    controller.stop({}, context, now, stopped);
  });
}

void Caller::cancel(std::size_t device) {
  const auto asked = ticket(device, "to cancel a motion");
  auto done = [asked](Result<void> cancelled) {
    if (!cancelled) expect_excuse(cancelled.error(), asked->asked());
    asked->answered();
  };
  const MotionId motion = newest_motion_[device];
  bench_.device(device).post([context = context(asked), motion, done](StageController& controller, TimePoint now) {
    controller.cancel_motion(motion, context, now, done);
  });
}

}  // namespace axisgate::stress
