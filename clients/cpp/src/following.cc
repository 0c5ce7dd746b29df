#include "clients/cpp/src/following.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <utility>

namespace axisgate::client {
namespace {

using google::protobuf::util::TimeUtil;

// Time without an answer after which the outcome of a motion counts as unknown.
constexpr std::chrono::seconds kLostLimit{60};
// Longest wait of one question, and the time for its answer.
constexpr milliseconds kWaitPart{10'000}, kAnswerTime{5000};

}  // namespace

v1::WaitMotionRequest Following::question(milliseconds wait) const {
  v1::WaitMotionRequest request;
  request.set_motion(motion_.name());
  *request.mutable_max_wait() = TimeUtil::MillisecondsToDuration(std::clamp(wait, milliseconds(0), kWaitPart).count());
  return request;
}

milliseconds Following::limit(const v1::WaitMotionRequest& question) {
  return milliseconds(TimeUtil::DurationToMilliseconds(question.max_wait())) + kAnswerTime;
}

void Following::take(v1::Motion motion, Clock::time_point now) {
  answered_ = now;
  backoff_.reset();
  if (motion.request_id() != motion_.request_id()) end("the daemon was restarted, and no longer has the motion");
  motion_ = std::move(motion);
}

milliseconds Following::pause_after(const Failure& failure, Clock::time_point now) {
  if (!failure.passing() && failure.reason() != "QUEUE_FULL") {
    try {
      throw_error(failure, target_);
    } catch (const Error& error) {
      end(fmt::format("its outcome cannot be read: {}", error.message()));
    }
  }
  if (now - answered_ > kLostLimit) end(fmt::format("the daemon has not answered for {} s", kLostLimit.count()));
  return backoff_.pause();
}

void Following::end(std::string_view why) const {
  throw OutcomeUnknown({.reason = "OUTCOME_UNKNOWN",
                        .message = fmt::format("the outcome of {} is unknown: {}", motion_.name(), why),
                        .hint = "look at the stage before you repeat the motion"});
}

}  // namespace axisgate::client
