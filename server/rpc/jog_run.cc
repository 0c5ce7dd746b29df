#include "server/rpc/jog_run.h"

#include <chrono>
#include <utility>
#include <variant>

#include "server/rpc/amounts.h"
#include "server/rpc/call.h"
#include "server/rpc/news.h"
#include "server/rpc/status.h"

namespace axisgate::rpc {
namespace {

using stage::StageController;
using JogAxes = std::vector<stage::JogRequest::Axis>;

// gRPC ends the reading alike for a client that has sent all and for one that broke off; only the second is then
// cancelled, at once but after.
constexpr Duration kBreakOffWait = std::chrono::milliseconds(10);

const Problem kBrokenOff{
    .reason = Reason::stopped, .message = "the call of the jog broke off", .hint = "see whether the client still runs"};

Result<JogAxes> to_jog_axes(const api::JogRequest& request, bool first) {
  JogAxes axes;
  for (const api::AxisJog& one : request.axes()) {
    const Result<int> axis = to_axis(one.axis());
    if (!axis) return tl::unexpected(axis.error());
    if (first && one.direction() != api::AxisJog::DIRECTION_PLUS && one.direction() != api::AxisJog::DIRECTION_MINUS) {
      return fail(Reason::invalid_request, "axis " + std::to_string(*axis) + " has no direction to jog in",
                  "set DIRECTION_PLUS or DIRECTION_MINUS");
    }
    axes.push_back({*axis, one.direction() == api::AxisJog::DIRECTION_MINUS ? -1 : 1, {}});
    if (!one.has_speed()) continue;
    const Result<Quantity> speed = to_quantity(one.speed());
    if (!speed) return tl::unexpected(speed.error());
    axes.back().speed = *speed;
  }
  return axes;
}

}  // namespace

JogRun* JogRun::start(server::Gateway& gateway, const server::Access& access,
                      const grpc::CallbackServerContext& context, Result<StreamLimit::Place> place) {
  std::shared_ptr<JogRun> run(new JogRun(gateway, access, context));
  run->open();
  if (!place) {
    run->refuse(place.error());
    return run.get();
  }
  run->place_ = *std::move(place);
  // The subscription ends in closed(), before the run does.
  run->subscription_ = gateway.events().subscribe([raw = run.get()] { raw->pump(); });
  run->StartRead(&run->incoming_);
  return run.get();
}

void JogRun::OnReadDone(bool ok) {
  if (!ok) {
    gateway_.after(kBreakOffWait, [run = self<JogRun>()] { run->stop({}); });
    return;
  }
  const Result<void> taken = device_ == nullptr ? take_first() : take_renewal();
  if (!taken) {
    refuse(taken.error());
    stop(taken.error());
  } else {
    StartRead(&incoming_);
  }
}

void JogRun::OnCancel() {
  stop(kBrokenOff);
  PullStream::OnCancel();
}

Result<void> JogRun::take_first() {
  const Result<server::Device*> device = find_device(gateway_, incoming_.device());
  if (!device) return tl::unexpected(device.error());
  const auto axes = to_jog_axes(incoming_, true);
  if (!axes) return tl::unexpected(axes.error());
  const auto asked = motion_context(context_, incoming_.context(), access_);
  if (!asked) return tl::unexpected(asked.error());
  device_ = *device;
  device_.load()->post([run = self<JogRun>(), request = stage::JogRequest{*axes, *asked}](
                           StageController& controller, TimePoint now) { run->begin(controller, request, now); });
  return {};
}

void JogRun::begin(StageController& controller, stage::JogRequest request, TimePoint now) {
  if (over_ || cancelled()) return refuse(kBrokenOff);
  {
    // Facts of this device are published on this strand only: none about this jog lies before this revision.
    const std::lock_guard lock(mutex_);
    reader_.go_to(gateway_.events().newest_revision() + 1);
  }
  motion_ = controller.jog(std::move(request), now,
                           [run = self<JogRun>()](const Result<stage::Motion>& motion) { run->show_or_end(motion); });
}

Result<void> JogRun::take_renewal() {
  const auto axes = to_jog_axes(incoming_, false);
  if (!axes) return tl::unexpected(axes.error());
  device_.load()->post([run = self<JogRun>(), axes = *axes](StageController& controller, TimePoint now) {
    if (run->motion_ == 0 || run->over_) return;
    const Result<void> renewed = controller.renew_jog(run->motion_, axes, now);
    // Of a jog that has ended the outcome is told.
    if (renewed || renewed.error().reason == Reason::not_found) return;
    run->refuse(renewed.error());
    run->stop(renewed.error());
  });
  return {};
}

void JogRun::stop(std::optional<Problem> why) {
  if (device_ == nullptr) {
    // Nothing was asked for.
    return refuse({.reason = Reason::invalid_request,
                   .message = "the jog names no device and no axis",
                   .hint = "send a first message"});
  }
  device_.load()->post([run = self<JogRun>(), why = std::move(why)](StageController& controller, TimePoint now) {
    run->over_ = true;
    if (run->motion_ != 0) controller.end_jog(run->motion_, why, now);
  });
}

void JogRun::refuse(const Problem& problem) {
  {
    const std::lock_guard lock(mutex_);
    if (!end_) end_ = to_status(problem);
  }
  pump();
}

void JogRun::show_or_end(const Result<stage::Motion>& motion) {
  if (!motion) return refuse(motion.error());
  {
    const std::lock_guard lock(mutex_);
    shown_ = motion->id;
    show(*motion, device_.load()->motion_revision(motion->id));
  }
  pump();
}

void JogRun::show(const stage::Motion& motion, std::uint64_t revision) {
  due_.emplace();
  *due_->mutable_motion() = to_proto(device_.load()->name(), motion, revision);
  if (stage::is_outcome(motion.state) && !end_) end_ = grpc::Status::OK;
}

JogRun::Next JogRun::next() {
  if (!due_ && !end_ && shown_ != 0) read_changes();
  if (due_) return *std::exchange(due_, std::nullopt);
  if (end_) return *end_;
  return Wait{};
}

void JogRun::read_changes() {
  while (!due_ && !end_) {
    const FactReader::Reading reading = reader_.next();
    if (std::holds_alternative<FactReader::Nothing>(reading)) return;
    if (std::holds_alternative<FactReader::Compacted>(reading)) return look();
    const server::FactRecord& record = *std::get<std::shared_ptr<const server::FactRecord>>(reading);
    const auto* change = std::get_if<stage::MotionChanged>(&record.fact);
    if (change != nullptr && change->motion.id == shown_ && record.device == device_.load()->name()) {
      show(change->motion, record.revision);
    }
  }
}

// Too slow for every change: the motion as it is now stands for those that were missed.
void JogRun::look() {
  shown_ = 0;
  device_.load()->post([run = self<JogRun>()](StageController& controller, TimePoint) {
    {
      const std::lock_guard lock(run->mutex_);
      run->reader_.go_to(run->gateway_.events().newest_revision() + 1);
    }
    run->show_or_end(find_motion(controller, run->motion_));
  });
}

}  // namespace axisgate::rpc
