#include "clients/axisctl/outcome.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/interrupt.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

constexpr std::chrono::milliseconds kPollEvery{200};

// Returns "; axis x ran from ..." for a scan that has started; otherwise empty.
std::string scan_of(const v1::Device& device, const v1::Motion& motion) {
  if (!motion.has_scan()) return "";
  return "; " + scan_text(find_axis(device, std::to_string(motion.axes(0))), motion.scan());
}

Failure failure_of_motion(const v1::Device& device, const v1::Motion& motion) {
  Failure failure = to_failure(motion.problem());
  failure.exit_code = kFailed;
  if (!motion.has_problem()) failure = {kFailed, state_name(motion.state()), "the motion did not succeed", ""};
  if (const std::string ends = ends_text(device, motion); !ends.empty()) failure.message += "; now " + ends;
  failure.message += scan_of(device, motion);
  return failure;
}

// Polls for the outcome, after the daemon has refused a stream: the caller may have used up its quota of streams. Calls
// have a separate quota.
v1::Motion poll_outcome(const Session& session, const std::string& motion) {
  v1::GetMotionRequest request;
  request.set_motion(motion);
  while (true) {
    const v1::Motion now =
        session.connection.call(session.connection.stage, &v1::StageService::Stub::GetMotion, request, kQuestionLimit)
            .motion();
    if (now.state() >= v1::MOTION_STATE_SUCCEEDED) return now;
    std::this_thread::sleep_for(kPollEvery);
  }
}

// Returns the outcome by polling. If polling also fails, the Failure says that the motion continues.
v1::Motion outcome_by_calls(const Session& session, const std::string& motion) {
  try {
    return poll_outcome(session, motion);
  } catch (const Failure& failure) {
    throw Failure{kFailed, "OUTCOME_UNKNOWN",
                  fmt::format("motion {} continues, and the daemon does not report its outcome: {}: {}",
                              last_part(motion), failure.reason, failure.message),
                  "check with `axisctl status` before you repeat it; to stop it: axisctl stop"};
  }
}

}  // namespace

std::string ends_text(const v1::Device& device, const v1::Motion& motion) {
  std::vector<std::string> ends;
  for (const v1::AxisResult& result : motion.results()) {
    if (!result.has_command_pulses()) continue;
    const v1::Axis& axis = find_axis(device, std::to_string(result.axis()));
    ends.push_back(place_text(axis, result.command_pulses()));
  }
  return fmt::format("{}", fmt::join(ends, ", "));
}

v1::Motion await_outcome(const Session& session, const std::string& motion) {
  grpc::ClientContext context;
  v1::WatchMotionRequest request;
  request.set_motion(motion);
  const auto reader = session.connection.stage->WatchMotion(&context, request);
  v1::WatchMotionResponse response;
  while (reader->Read(&response)) {
  }
  const grpc::Status status = reader->Finish();
  if (status.ok() && response.motion().state() >= v1::MOTION_STATE_SUCCEEDED) return response.motion();
  if (status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED) return outcome_by_calls(session, motion);
  throw Failure{kFailed, "OUTCOME_UNKNOWN",
                fmt::format("connection lost during motion {}: {}", last_part(motion), status.error_message()),
                "the axes may still be moving: check with `axisctl status` before you repeat it"};
}

int report_outcome(const Session& session, const v1::Device& device, const v1::Motion& motion) {
  if (session.options.json) {
    v1::WatchMotionResponse outcome;
    *outcome.mutable_motion() = motion;
    print_json(outcome);
  }
  if (motion.state() != v1::MOTION_STATE_SUCCEEDED) throw failure_of_motion(device, motion);
  if (!session.options.json) print_line("done: " + ends_text(device, motion) + scan_of(device, motion));
  return kDone;
}

int report_started(const Session& session, const v1::Motion& motion) {
  if (session.options.json) {
    v1::WatchMotionResponse started;
    *started.mutable_motion() = motion;
    print_json(started);
  } else {
    print_line(fmt::format("started: motion {}", last_part(motion.name())));
  }
  return kDone;
}

namespace {

// Returns the outcome, even if the daemon was killed and has restarted: `start` then sends the same request again, and
// the daemon answers with its result.
v1::Motion outcome_of(const Session& session, v1::Motion motion, const std::function<v1::Motion()>& start) {
  while (motion.state() < v1::MOTION_STATE_SUCCEEDED) {
    try {
      return await_outcome(session, motion.name());
    } catch (const Failure& lost) {
      if (!session.connection.repeats()) throw;
      try {
        motion = start();
      } catch (const Failure&) {
        throw lost;
      }
    }
  }
  return motion;
}

}  // namespace

int start_and_wait(const Session& session, const v1::Device& device, const std::function<v1::Motion()>& start) {
  if (session.options.no_wait) return report_started(session, start());
  MotionFollower follower(session, device);
  const v1::Motion started = start();
  say_on_interrupt_that_motion_continues();
  follower.follow(started.name());
  const v1::Motion outcome = outcome_of(session, started, start);
  follower.finish();
  return report_outcome(session, device, outcome);
}

void say_on_interrupt_that_motion_continues() { say_on_interrupt("the motion continues; to stop it: axisctl stop"); }

}  // namespace axisgate::axisctl
