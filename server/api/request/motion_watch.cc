#include "server/api/request/motion_watch.h"

#include <fmt/format.h>

#include <memory>
#include <utility>
#include <variant>

#include "server/journal/answers.h"

namespace axisgate::api {

namespace {

tl::unexpected<Problem> not_kept(const stage::StageController& controller, stage::MotionId id) {
  return fail(
      Reason::not_found, fmt::format("there is no motion {} on {}", id, controller.profile().name),
      fmt::format("the newest {} since the daemon started are kept, `ListMotions` shows them; `ListHistory` may "
                  "have it",
                  stage::StageController::kMotionsKept));
}

}  // namespace

Result<CurrentMotion> find_motion(const server::EventBus& bus, server::Stage& device,
                                  const stage::StageController& controller, stage::MotionId id) {
  if (std::optional<stage::Motion> motion = controller.find_motion(id))
    return CurrentMotion(device, *std::move(motion));
  const server::FactPointer newest = bus.find_motion(device.name(), id);
  if (newest == nullptr) return not_kept(controller, id);
  return CurrentMotion(device, std::get<stage::MotionChanged>(newest->fact).motion, newest->revision, newest->clock);
}

Result<stage::Motion> motion_of(const server::journal::RequestMemory::Known& known,
                                const stage::StageController& controller) {
  if (auto motion = controller.find_motion(known.motion)) return *std::move(motion);
  if (known.open) return not_kept(controller, known.motion);
  if (auto problem = server::journal::problem_in(known.answer)) return tl::unexpected(*std::move(problem));
  if (auto motion = server::journal::motion_in(known.answer)) return *std::move(motion);
  return fail(Reason::internal, "what became of the request cannot be read", "look at the history: `ListHistory`");
}

void MotionSubscription::follow_from_now() {
  const std::lock_guard lock(mutex_);
  reader_.go_to_newest();
}

void MotionSubscription::show(server::Stage& device, const Result<stage::Motion>& motion) {
  if (!motion) return end(motion.error());
  follow(device, CurrentMotion(device, *motion));
}

void MotionSubscription::show_repeated(server::Stage& device, const stage::StageController& controller,
                                       const Result<server::journal::RequestMemory::Known>& known) {
  if (!known) return end(known.error());
  follow_from_now();
  const auto motion = motion_of(*known, controller);
  motion ? follow(device, CurrentMotion::repeated(device, *motion)) : end(motion.error());
}

void MotionSubscription::follow(server::Stage& device, CurrentMotion motion) {
  {
    const std::lock_guard lock(mutex_);
    device_ = &device;
    followed_ = motion.motion.id;
    set_due(std::move(motion));
  }
  wake();
}

void MotionSubscription::end(const Problem& problem) {
  {
    const std::lock_guard lock(mutex_);
    if (!end_) end_ = StreamEnd{problem};
  }
  wake();
}

void MotionSubscription::set_due(CurrentMotion motion) {
  if (stage::is_outcome(motion.motion.state) && !end_) end_ = StreamEnd{};
  shown_ = motion.revision;
  due_ = std::move(motion);
}

void MotionSubscription::look(server::Stage& device, stage::MotionId id) {
  device.post([self = self<MotionSubscription>(), &device, id](stage::StageController& controller, TimePoint) {
    self->follow_from_now();
    const auto motion = find_motion(self->gateway_.events(), device, controller, id);
    motion ? self->follow(device, *motion) : self->end(motion.error());
  });
}

MotionSubscription::Reading MotionSubscription::read() {
  if (!due_ && !end_ && device_ != nullptr) read_changes();
  if (due_) {
    CurrentMotion motion = *std::move(due_);
    due_.reset();
    return motion;
  }
  if (end_) return *end_;
  return Nothing{};
}

void MotionSubscription::read_changes() {
  while (!due_ && !end_) {
    const FactReader::Reading reading = reader_.next();
    if (std::holds_alternative<FactReader::Nothing>(reading)) return;
    if (std::holds_alternative<FactReader::Compacted>(reading)) {
      return look(*std::exchange(device_, nullptr), followed_);
    }
    const server::FactRecord& record = *std::get<std::shared_ptr<const server::FactRecord>>(reading);
    const auto* change = std::get_if<stage::MotionChanged>(&record.fact);
    const bool newer = record.revision > shown_;  // the answer to a request may be newer than the next events
    if (change != nullptr && newer && change->motion.id == followed_ && record.device == device_->name()) {
      set_due(CurrentMotion(*device_, change->motion, record.revision, record.clock));
    }
  }
}

void MotionWatch::begin() {
  MotionSubscription::begin();
  look(*name_.device, name_.id);
}

}  // namespace axisgate::api
