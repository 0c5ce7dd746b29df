#include "server/api/jogs.h"

#include <fmt/format.h>

#include <utility>

#include "server/api/audit.h"
#include "server/api/names.h"
#include "server/api/request_texts.h"

namespace axisgate::api {
namespace {

using stage::StageController;
using JogAxes = std::vector<JogAxis>;

const Problem kBrokenOff{
    .reason = Reason::stopped, .message = "the call of the jog broke off", .hint = "see whether the client still runs"};

std::vector<stage::JogRequest::Axis> request_axes(const JogAxes& axes) {
  std::vector<stage::JogRequest::Axis> all;
  for (const JogAxis& one : axes) all.push_back({one.axis, one.direction.value_or(1), one.speed});
  return all;
}

std::optional<Problem> check_directions(const Result<JogAxes>& axes) {
  if (!axes) return axes.error();
  for (const JogAxis& one : *axes) {
    if (one.direction) continue;
    return Problem{.reason = Reason::invalid_request,
                   .message = fmt::format("axis {} has no direction to jog in", one.axis),
                   .hint = "set DIRECTION_PLUS or DIRECTION_MINUS"};
  }
  return {};
}

}  // namespace

Result<std::shared_ptr<Jog>> Jogs::open(const Credential& caller) const {
  Result<Streams::Place> place = streams_.take(RequestKind::jog, name_of(caller));
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<Jog>(gateway_, pipeline_, *std::move(place));
}

bool Jog::start(const Call& call, std::string_view device, const Result<JogAxes>& axes) {
  const Result<void> posted = post_start(call, device, axes);
  return posted || refuse(posted.error());
}

bool Jog::renew(const Result<JogAxes>& axes) {
  const Result<void> posted = post_renewal(*device(), axes);
  return posted || refuse(posted.error());
}

Result<void> Jog::post_start(const Call& call, std::string_view device, const Result<JogAxes>& axes) {
  const auto admitted = pipeline_.admit({RequestKind::jog, call, find_stage(gateway_, device), check_directions(axes)});
  if (!admitted) return tl::unexpected(admitted.error());
  {
    const std::lock_guard lock(mutex_);
    jogged_ = admitted->device;
  }
  admitted->device->post(
      [self = self<Jog>(), &device = *admitted->device,
       request = stage::JogRequest{request_axes(*axes), admitted->context}](
          StageController& controller, TimePoint now) { self->begin_on(device, controller, request, now); });
  return {};
}

void Jog::begin_on(server::Stage& device, StageController& controller, stage::JogRequest request, TimePoint now) {
  {
    const std::lock_guard lock(mutex_);
    over_ = over_ || broken_off_;
  }
  if (over_) return end(kBrokenOff);
  if (const auto good = check_deadline(RequestKind::jog, request.context, now); !good) return end(good.error());
  follow_from_now();
  audit(RequestKind::jog, device, request.context, text_of(request));
  motion_ = controller.jog(std::move(request), now, [self = self<Jog>(), &device](const Result<stage::Motion>& motion) {
    self->show(device, motion);
  });
}

Result<void> Jog::post_renewal(server::Stage& device, const Result<JogAxes>& axes) {
  if (!axes) return tl::unexpected(axes.error());
  device.post([self = self<Jog>(), axes = request_axes(*axes)](StageController& controller, TimePoint now) {
    if (self->motion_ == 0 || self->over_) return;
    const Result<void> renewed = controller.renew_jog(self->motion_, axes, now);
    // Of a jog that has ended its reader receives the outcome.
    if (!renewed && renewed.error().reason != Reason::not_found) self->refuse(renewed.error());
  });
  return {};
}

void Jog::finish() { stop({}); }

void Jog::break_off() {
  {
    const std::lock_guard lock(mutex_);
    broken_off_ = true;
  }
  stop(kBrokenOff);
}

bool Jog::refuse(const Problem& problem) {
  end(problem);
  stop(problem);
  return false;
}

void Jog::stop(std::optional<Problem> why) {
  server::Stage* const jogged = device();
  if (jogged == nullptr) {
    return end({.reason = Reason::invalid_request,
                .message = "the jog names no device and no axis",
                .hint = "send a first message"});
  }
  jogged->post([self = self<Jog>(), why = std::move(why)](StageController& controller, TimePoint now) {
    self->over_ = true;
    if (self->motion_ != 0) controller.end_jog(self->motion_, why, now);
  });
}

server::Stage* Jog::device() {
  const std::lock_guard lock(mutex_);
  return jogged_;
}

}  // namespace axisgate::api
