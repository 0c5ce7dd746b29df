#include "server/api/request/repeats.h"

#include "device/stage/stage_controller.h"

namespace axisgate::api {

void repeat_motion(server::Stage& device, const Result<Known>& known, const Answer<StartedMotion>& answer) {
  if (!known) return answer(tl::unexpected(known.error()));
  device.post([&device, known, answer](const stage::StageController& controller, TimePoint) {
    Result<stage::Motion> motion = motion_of(*known, controller);
    if (!motion) return answer(tl::unexpected(motion.error()));
    answer(CurrentMotion::repeated(device, *std::move(motion)));
  });
}

void repeat_done(const Result<Known>& known, const Answer<void>& answer) {
  if (!known) return answer(tl::unexpected(known.error()));
  const auto problem = server::journal::problem_in(known->answer);
  answer(problem ? tl::unexpected(*problem) : Result<void>());
}

}  // namespace axisgate::api
