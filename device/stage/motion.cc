#include "device/stage/motion.h"

#include <fmt/format.h>

#include "device/core/spans.h"

namespace axisgate::stage {

use::Occupation occupation_by(const Motion& motion) {
  const std::string by = fmt::format("{} by {}", name(motion.kind), motion.who);
  const std::string what = fmt::format("motion {}", motion.id);
  if (motion.axes.empty()) return {by, what, " sets the controller", motion.due};
  const std::string_view verb = motion.axes.count() == 1 ? "is" : "are";
  return {by, fmt::format("{} {} in {}", to_string(motion.axes), verb, what), "", motion.due};
}

std::string_view name(MotionKind kind) {
  switch (kind) {
    case MotionKind::move:
      return "move";
    case MotionKind::home:
      return "home";
    case MotionKind::return_to_origin:
      return "return-to-origin";
    case MotionKind::path:
      return "path";
    case MotionKind::execute:
      return "execute";
    case MotionKind::jog:
      return "jog";
    case MotionKind::scan:
      return "scan";
  }
  return "unspecified";
}

std::string_view name(MotionState state) {
  switch (state) {
    case MotionState::queued:
      return "QUEUED";
    case MotionState::running:
      return "RUNNING";
    case MotionState::stopping:
      return "STOPPING";
    case MotionState::succeeded:
      return "SUCCEEDED";
    case MotionState::stopped:
      return "STOPPED";
    case MotionState::failed:
      return "FAILED";
    case MotionState::unknown:
      return "UNKNOWN";
  }
  return "UNKNOWN";
}

}  // namespace axisgate::stage
