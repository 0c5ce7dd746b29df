// Parts of a rotor's controller besides its motions: the link, readings, stops, and the end.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/stage/own_questions.h"
#include "tests/double/controller.h"

namespace axisgate::rotor {
namespace {

constexpr Duration kStopWriteLimit = std::chrono::seconds(1), kStandstillLimit = std::chrono::seconds(5);
constexpr Duration kStopPoll = std::chrono::milliseconds(50);
const Scale kScale{{2500, 0}, true};  // 0.0025 degrees per pulse

}  // namespace

// Checks the right again, because it may have ended since the start was queued.
std::optional<Problem> Controller::may_write(const Asked& asked) {
  if (asked.motion == 0) return {};
  Live* live = find(asked.motion);
  if (live == nullptr) return Problem{.reason = Reason::stopped, .message = "the motion has ended"};
  const auto good = permission_.authorize({live->context.who, live->context.lease, kAxis, asked.motion}, now_);
  if (!good) return good.error();
  live->wrote = live->motion.written = true;
  return {};
}

void Controller::wire_open() {
  state_.link = LinkState::connecting;
  emit(LinkChanged{LinkState::connecting, "the line is open"});
  if (runaway_) {
    stop_rotor(kAxis, false, "the gateway: a jog ran on while the line was lost", [](const StopReport&) {});
  }
  wire_.ask({.opcode = Opcode::identify,
             .lane = Lane::question,
             .who = kGateway,
             .not_after = TimePoint::max(),
             .done = [this](const Answer& answer) { identified(answer); }},
            now_);
}

void Controller::identified(const Answer& answer) {
  if (!answer.payload) return;
  const auto told = static_cast<std::uint32_t>(*answer.payload);
  const std::string serial_number = std::to_string(told & 0xFFFFFFu);
  const std::string& expected = profile_.serial_number.empty() ? unit_ : profile_.serial_number;
  if (!expected.empty() && serial_number != expected) {
    return wire_.lose(fmt::format("rotor {} answers, but {} is expected", serial_number, expected), now_);
  }
  state_.vendor = "Axisgate";
  state_.model = "ROTOR";
  state_.serial_number = unit_ = serial_number;
  state_.firmware = std::to_string(told >> 24);
  ask_status(Lane::question, kGateway, [this](const Answer& status) {
    if (status.payload) come_up();
  });
}

void Controller::come_up() {
  if (++state_.device_epoch > 1) permission_.device_restarted(now_);
  state_.epoch_began = now_;
  ++state_.frame_epoch;
  state_.axis(1).homed = false;
  state_.axis(1).controllable = true;
  state_.axis(1).scale = kScale;
  state_.link = LinkState::up;
  state_.link_problem.clear();
  wire_.proved_good();
  emit(LinkChanged{LinkState::up, "", kAxis});
  emit(StateChanged{});
}

void Controller::wire_lost(const std::string& why) {
  const bool news = state_.link != LinkState::down || state_.link_problem != why;
  state_.link = LinkState::down;
  state_.link_problem = why;
  state_.moving_unknown = state_.moving_unknown || state_.axis(1).busy.value_or(false);
  state_.axis(1).busy.reset();
  state_.axis(1).position_pulses.reset();
  while (!live_.empty()) {
    const auto& [id, live] = *live_.begin();
    const bool wrote = live.wrote;
    state_.moving_unknown = state_.moving_unknown || wrote;
    runaway_ = runaway_ || (wrote && live.jog);
    end(id, wrote ? MotionState::unknown : MotionState::failed,
        Problem{.reason = wrote ? Reason::outcome_unknown : Reason::not_sent,
                .message = fmt::format("the line was lost {}: {}",
                                       wrote ? "while the motion was in progress" : "before the motion was sent", why),
                .hint = "look at the position before moving on"});
  }
  look_after_stops();
  if (!news) return;
  emit(LinkChanged{LinkState::down, why});
  emit(StateChanged{});
}

void Controller::ask_status(Lane lane, std::string who, std::function<void(const Answer&)> then, TimePoint not_after) {
  ++looking_;
  const auto done = [this, then = std::move(then)](const Answer& answer) {
    --looking_;
    looked_ = now_;
    if (answer.payload) apply_status(*answer.payload);
    if (then) then(answer);
  };
  wire_.ask({.opcode = Opcode::status, .lane = lane, .who = std::move(who), .not_after = not_after, .done = done},
            now_);
}

void Controller::apply_status(std::int32_t payload) {
  const bool busy = (payload & 1) != 0;
  origin_found_ = (payload & 2) != 0;
  state_.axis(1).position_pulses = sign_ * (payload >> 2);
  state_.axis(1).busy = busy;
  state_.read = now_;
  if (!busy) runaway_ = state_.moving_unknown = false;
  tell_foreign_motion(busy);
  emit(StateChanged{});
  judge();
  look_after_stops();
  keep_jogs();
}

// Reports foreign motion after two readings, because a single one may show a motion that has just ended.
void Controller::tell_foreign_motion(bool busy) {
  const bool ours = !live_.empty() && live_.begin()->second.wrote;
  const bool strange = busy && !ours;
  const bool told = std::exchange(state_.axis(1).foreign_motion, strange && strange_before_);
  if (!told && state_.axis(1).foreign_motion) emit(ForeignMotion{kAxis});
  strange_before_ = strange;
}

std::optional<TimePoint> Controller::poll_at() const {
  const bool over = ending_ && !on_wound_down_;
  if (state_.link != LinkState::up || looking_ > 0 || over) return {};
  if (!stops_.empty()) return looked_ + kStopPoll;
  const bool moves = state_.axis(1).busy.value_or(false) || !live_.empty();
  return looked_ + (moves ? profile_.moving_poll : profile_.idle_poll);
}

void Controller::stop(AxisSet axes, const RequestContext& context, TimePoint now, OnStopped done) {
  at(now, [&] {
    permission_.stop_asked({context.who, context.lease, axes.empty() ? AxisSet::first(kAxesMax) : axes, 0}, {}, now);
    stop_rotor(axes.empty() ? kAxis : axes, false, context.who, std::move(done));
  });
}

// Stops the rotor like stop(): the rotor has only one stop command.
void Controller::emergency_stop(const RequestContext& context, TimePoint now, OnStopped done) {
  at(now, [&] {
    permission_.stop_asked({context.who, context.lease, AxisSet::first(kAxesMax), 0}, {}, now);
    stop_rotor(kAxis, true, context.who, std::move(done));
  });
}

void Controller::stop_rotor(AxisSet axes, bool emergency, const std::string& who, OnStopped done) {
  emit(StopRequested{axes.has(1) ? kAxis : axes, emergency, who});
  if (!axes.has(1)) {
    StopReport report;
    report.problem = Problem{.reason = Reason::unknown_axis, .message = "a rotor has axis 1 only"};
    return done(report);
  }
  flush_motions(who);
  if (!stops_.empty() && !stops_.back()->stands_by) {
    stops_.back()->done.push_back(std::move(done));
    return;
  }
  auto job = std::make_shared<StopJob>();
  job->done.push_back(std::move(done));
  job->report.axes = {{.axis = 1, .wire_reply = {}, .named = true, .ready = {}, .position_pulses = {}}};
  stops_.push_back(job);
  wire_.ask({.opcode = Opcode::stop,
             .lane = Lane::stop,
             .who = who,
             .not_after = now_ + kStopWriteLimit,
             .done = [this, job](const Answer& answer) { stop_answered(job, answer); }},
            now_);
}

// Marks running motions as stopping, and ends the motions whose start was not yet written.
void Controller::flush_motions(const std::string& who) {
  std::vector<MotionId> unsent;
  for (auto& [id, live] : live_) {
    if (!live.wrote) unsent.push_back(id);
    if (live.stopped_by.empty()) live.stopped_by = who;
    if (live.motion.state != MotionState::running) continue;
    live.motion.state = MotionState::stopping;
    wire_.withdraw(id);  // a new speed would start the jog again
    emit(MotionChanged{live.motion});
  }
  for (const MotionId id : unsent) {
    end(id, MotionState::stopped,
        Problem{.reason = Reason::stopped,
                .message = fmt::format("a stop by {} came before the motion was sent", who),
                .hint = "ask again if the motion is still wanted"});
  }
}

void Controller::stop_answered(const StopJobPtr& job, const Answer& answer) {
  if (answer.payload) {
    job->report.axes[0].wire_reply = *answer.payload == 0 ? "OK" : "NG";
    job->stands_by = now_ + kStandstillLimit;
    if (state_.link == LinkState::up) return ask_status(Lane::motion, kGateway);
  }
  job->report.problem = answer.problem.value_or(Problem{.reason = Reason::outcome_unknown});
  job->report.problem->hint = "use the wired emergency stop if it moves";
  if (answer.written) {
    job->report.problem->reason = Reason::outcome_unknown;
    job->report.problem->message = "the stop was written, but nobody can tell yet what became of it";
  } else {
    job->report.problem->message.insert(0, "the stop could not be written: ");
  }
  finish_stop(job);
}

void Controller::finish_stop(const StopJobPtr& job) {
  std::erase(stops_, job);
  job->report.axes[0].ready = state_.axis(1).busy ? std::optional(!*state_.axis(1).busy) : std::nullopt;
  job->report.axes[0].position_pulses = state_.axis(1).position_pulses;
  for (const auto& done : job->done) done(job->report);
}

void Controller::look_after_stops() {
  const auto all = stops_;
  for (const auto& job : all) {
    if (!job->stands_by) continue;
    const bool stands = state_.link == LinkState::up && state_.axis(1).busy == false && state_.read == now_;
    if (!stands && state_.link == LinkState::up && now_ < *job->stands_by) continue;
    if (!stands) {
      job->report.problem = Problem{.reason = Reason::outcome_unknown,
                                    .message = "the rotor was not seen to stand still",
                                    .hint = "use the wired emergency stop if it moves"};
    }
    finish_stop(job);
  }
}

void Controller::carry_out_orders() {
  const Orders orders = permission_.advance(now_);
  for (const StopOrder& order : orders.stops) {
    stop_rotor(AxisSet::in(order.scope), false, "the gateway on behalf of " + order.who,
               [this, id = order.id](const StopReport&) { permission_.stopped(id, now_); });
  }
  for (const EndedLease& lease : orders.restoring) permission_.settings_restored(lease.token, now_);
}

void Controller::cancel_motion(MotionId id, const RequestContext& context, TimePoint now, OnDone done) {
  at(now, [&] {
    const Live* live = find(id);
    if (live == nullptr) {
      return done(find_motion(id) ? Result<void>() : fail(Reason::not_found, fmt::format("there is no motion {}", id)));
    }
    if (live->has_turn) {
      return stop_rotor(kAxis, false, context.who, [done](const StopReport& report) {
        done(report.problem ? Result<void>(tl::unexpected(*report.problem)) : Result<void>());
      });
    }
    end(id, MotionState::stopped,
        Problem{.reason = Reason::stopped, .message = "cancelled by " + context.who + " before it was sent"});
    done({});
  });
}

void Controller::wind_down(TimePoint now, OnWoundDown done) {
  at(now, [&] {
    ending_ = Problem{.reason = Reason::not_sent,
                      .message = "the gateway is ending and now sends only stops",
                      .hint = "try again when it runs again"};
    on_wound_down_ = std::move(done);
    last_report_ = std::make_shared<WindDownReport>();
    for (const auto& [id, live] : live_) unfinished_.push_back(id);
    for (const MotionId id : unfinished_) {
      if (!live_.at(id).wrote) end(id, MotionState::failed, ending_);
    }
    ending_limit_ = now + kFinishLimit;
    if (profile_.at_exit == AtExit::stop) return begin_last_stop();
    for (auto& [id, live] : live_) {
      if (!live.jog || live.jog->ended) continue;
      live.jog->ended = true;  // a jog never ends by itself
      live.jog->why = ending_;
      live.jog->stop_at = now;
    }
    keep_jogs();
  });
}

void Controller::begin_last_stop() {
  last_stop_ = true;
  ending_limit_ = now_ + kStopLimit;
  if (live_.empty() && !state_.moving_unknown) return;
  stop_rotor(kAxis, false, "the gateway, which is ending",
             [report = last_report_](const StopReport& stopped) { report->problem = stopped.problem; });
}

bool Controller::wind_on() {
  if (!on_wound_down_) return false;
  const bool rest = live_.empty() && stops_.empty();
  if (!rest && now_ < ending_limit_) return false;
  if (!last_stop_) {
    begin_last_stop();
    return true;
  }
  while (!live_.empty()) {
    end(live_.begin()->first, MotionState::unknown,
        Problem{.reason = Reason::outcome_unknown,
                .message = "the gateway ended before it could see what became of the motion",
                .hint = "look at the rotor"});
  }
  wire_.seal();
  if (wire_.exchanging()) return false;
  for (const MotionId id : unfinished_) {
    if (const auto motion = find_motion(id)) last_report_->motions.push_back(*motion);
  }
  std::exchange(on_wound_down_, {})(*last_report_);
  return false;
}

}  // namespace axisgate::rotor
