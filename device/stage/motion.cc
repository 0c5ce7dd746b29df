#include "device/stage/motion.h"

#include <fmt/format.h>

#include "device/core/spans.h"

namespace axisgate::stage {

std::string occupation_by(const Motion& motion, TimePoint now) {
  std::string left;
  if (motion.due && *motion.due > now) {
    left = fmt::format(", {} left", for_people(std::chrono::ceil<std::chrono::seconds>(*motion.due - now)));
  }
  const std::string what = fmt::format("motion {} ({} by {}{})", motion.id, name(motion.kind), motion.who, left);
  if (motion.axes.empty()) return what + " sets the controller";
  return fmt::format("{} {} in {}", to_string(motion.axes), motion.axes.count() == 1 ? "is" : "are", what);
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
