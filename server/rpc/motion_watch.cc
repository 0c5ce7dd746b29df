#include "server/rpc/motion_watch.h"

#include <utility>
#include <variant>

#include "server/rpc/news.h"
#include "server/rpc/status.h"

namespace axisgate::rpc {

MotionWatch* MotionWatch::start(server::Gateway& gateway, const MotionName& motion, StreamLimit::Place place) {
  std::shared_ptr<MotionWatch> watch(new MotionWatch(gateway, motion, std::move(place)));
  watch->open();
  // The subscription ends in closed(), before the watch does.
  watch->subscription_ = watch->bus_.subscribe([raw = watch.get()] { raw->pump(); });
  watch->look();
  return watch.get();
}

void MotionWatch::look() {
  motion_.device->post([watch = self<MotionWatch>()](stage::StageController& controller, TimePoint) {
    const Result<stage::Motion> motion = find_motion(controller, watch->motion_.id);
    {
      const std::lock_guard lock(watch->mutex_);
      // Facts of this device are published on this strand only: none comes between the motion seen and this revision.
      watch->reader_.go_to(watch->bus_.newest_revision() + 1);
      watch->looking_ = false;
      if (motion) {
        watch->show(*motion, watch->motion_.device->motion_revision(motion->id));
      } else {
        watch->end_ = to_status(motion.error());
      }
    }
    watch->pump();
  });
}

void MotionWatch::show(const stage::Motion& motion, std::uint64_t revision) {
  due_.emplace();
  *due_->mutable_motion() = to_proto(motion_.device->name(), motion, revision);
  if (stage::is_outcome(motion.state)) end_ = grpc::Status::OK;
}

MotionWatch::Next MotionWatch::next() {
  while (!due_ && !end_ && !looking_) {
    const FactReader::Reading reading = reader_.next();
    if (std::holds_alternative<FactReader::Nothing>(reading)) return Wait{};
    if (std::holds_alternative<FactReader::Compacted>(reading)) {
      // Too slow for every change: the motion as it is now stands for those that were missed.
      looking_ = true;
      look();
      return Wait{};
    }
    const server::FactRecord& record = *std::get<std::shared_ptr<const server::FactRecord>>(reading);
    const auto* change = std::get_if<stage::MotionChanged>(&record.fact);
    if (change != nullptr && change->motion.id == motion_.id && record.device == motion_.device->name()) {
      show(change->motion, record.revision);
    }
  }
  if (due_) return *std::exchange(due_, std::nullopt);
  if (end_) return *end_;
  return Wait{};
}

}  // namespace axisgate::rpc
