#include "server/api/stage/jogs.h"

#include <fmt/format.h>

#include <utility>

#include "server/access/access.h"
#include "server/api/request/awaited.h"
#include "server/api/request/names.h"
#include "server/api/request/request_texts.h"

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

// Renews a jog for a caller that cannot do so before its answer names the motion.
void renew_until_started(server::Timeouts& timeouts, const std::shared_ptr<Jog>& jog,
                         const std::weak_ptr<Awaited<CurrentMotion>>& waiting) {
  timeouts.after(StageController::kJogSilence / 4, [&timeouts, jog, waiting] {
    if (waiting.expired() || !jog->renew(JogAxes())) return;
    renew_until_started(timeouts, jog, waiting);
  });
}

Result<void> check_own_jog(const stage::Motion& motion, std::string_view who) {
  if (motion.kind != stage::MotionKind::jog) {
    return fail(Reason::invalid_request, fmt::format("motion {} is not a jog", motion.id), "CancelMotion stops it");
  }
  if (server::identity_of(motion.who) == server::identity_of(who)) return {};
  return fail(Reason::not_allowed, fmt::format("motion {} is a jog of {}", motion.id, motion.who),
              "CancelMotion or Stop stops it");
}

}  // namespace

Result<std::shared_ptr<Jog>> Jogs::open(const Credential& caller) const {
  Result<Streams::Place> place = streams_.take(RequestKind::jog, name_of(caller));
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<Jog>(gateway_, pipeline_, *std::move(place));
}

std::function<void()> Jogs::start(const Call& call, std::string_view device, const Result<JogAxes>& axes,
                                  const Answer<StartedMotion>& answer) const {
  const auto opened = open(call.credential);
  if (!opened) {
    answer(tl::unexpected(opened.error()));
    return {};
  }
  const std::shared_ptr<Jog>& jog = *opened;
  const auto waiting = Awaited<CurrentMotion>::start(
      jog, [](const CurrentMotion&) { return true; },
      [jog, answer](const Result<StartedMotion>& started) {
        if (started && *started) (void)jog->renew(JogAxes());
        answer(started);
      });
  if (jog->start(call, device, axes)) renew_until_started(gateway_.timeouts(), jog, waiting);
  return [started = std::weak_ptr(waiting), jog] {
    const auto still = started.lock();
    if (!still) return;
    still->leave();
    jog->break_off();
  };
}

template <class Outcome, class Act>
void Jogs::on_jog(RequestKind kind, const Call& call, std::string_view motion, Answer<Outcome> answer, Act act) const {
  const Result<MotionName> name = find_motion_name(gateway_, motion);
  pipeline_.ask({kind, call, device_of(name)}, std::move(answer),
                [&bus = gateway_.events(), id = name ? name->id : 0, act = std::move(act)](
                    const Turn& turn, const Answer<Outcome>& respond) {
                  const Result<CurrentMotion> jog = find_motion(bus, turn.device, turn.controller, id);
                  if (!jog) return respond(tl::unexpected(jog.error()));
                  const Result<void> good = check_own_jog(jog->motion, turn.caller.who);
                  if (!good) return respond(tl::unexpected(good.error()));
                  act(turn, *jog, respond);
                });
}

void Jogs::keep(const Call& call, std::string_view motion, std::int64_t number, const Result<JogAxes>& axes,
                Answer<KeptJog> answer) const {
  on_jog(RequestKind::keep_jog, call, motion, std::move(answer),
         [&bus = gateway_.events(), numbers = numbers_, number, axes](const Turn& turn, const CurrentMotion& jog,
                                                                      const Answer<KeptJog>& respond) {
           const stage::MotionId id = jog.motion.id;
           const auto refuse = [&](const Problem& problem) {
             turn.controller.end_jog(id, problem, turn.now);
             respond(tl::unexpected(problem));
           };
           if (!axes) return refuse(axes.error());
           numbers->forget_ended(&turn.device, [&](stage::MotionId one) {
             const auto found = turn.controller.find_motion(one);
             return !found || stage::is_outcome(found->state);
           });
           if (stage::is_outcome(jog.motion.state) || !numbers->counts(&turn.device, id, number)) {
             return respond(KeptJog{jog, false});
           }
           const Result<void> renewed = turn.controller.renew_jog(id, request_axes(*axes), turn.now);
           if (!renewed && renewed.error().reason != Reason::not_found) return refuse(renewed.error());
           const Result<CurrentMotion> now = find_motion(bus, turn.device, turn.controller, id);
           respond(KeptJog{now.value_or(jog), renewed.has_value()});
         });
}

void Jogs::stop(const Call& call, std::string_view motion, Answer<CurrentMotion> answer) const {
  on_jog(RequestKind::stop_jog, call, motion, std::move(answer),
         [&bus = gateway_.events()](const Turn& turn, const CurrentMotion& jog, const Answer<CurrentMotion>& respond) {
           turn.controller.end_jog(jog.motion.id, {}, turn.now);
           respond(find_motion(bus, turn.device, turn.controller, jog.motion.id));
         });
}

bool Jog::start(const Call& call, std::string_view device, const Result<JogAxes>& axes) {
  const Result<server::Stage*> found = find_stage(gateway_, device);
  {
    const std::lock_guard lock(mutex_);
    jogged_ = found.value_or(nullptr);
  }
  pipeline_.act(
      {RequestKind::jog, call, found, check_directions(axes)},
      [self = self<Jog>(), axes](const Turn& turn) -> Result<std::string> {
        if (self->is_over()) return tl::unexpected(kBrokenOff);
        const stage::JogRequest request{request_axes(*axes), turn.context};
        Result<void> good = check_deadline(RequestKind::jog, turn.context, turn.now);
        if (good) good = turn.controller.check_use(turn.context, axes_used(request, turn.controller.state()));
        if (!good) return tl::unexpected(good.error());
        return text_of(request);
      },
      [self = self<Jog>(), axes](const Turn& turn, const MutationPtr& mutation) {
        self->begin_on(turn, *axes, mutation);
      },
      [self = self<Jog>()](const Problem& problem) { (void)self->refuse(problem); },
      [self = self<Jog>()](server::Stage& its_device, const Result<Known>& known) { self->repeat(its_device, known); });
  const std::lock_guard lock(mutex_);
  return !refused_;
}

bool Jog::renew(const Result<JogAxes>& axes) {
  const Result<void> posted = post_renewal(*device(), axes);
  return posted || refuse(posted.error());
}

bool Jog::is_over() {
  const std::lock_guard lock(mutex_);
  over_ = over_ || broken_off_;
  return over_;
}

void Jog::begin_on(const Turn& turn, const JogAxes& axes, const MutationPtr& mutation) {
  follow_from_now();
  motion_ = turn.controller.jog({request_axes(axes), turn.context}, turn.now,
                                [self = self<Jog>(), mutation, &device = turn.device](Result<stage::Motion> motion) {
                                  motion ? mutation->acted({}) : mutation->failed(motion.error());
                                  self->show(device, motion);
                                });
}

// Never starts a second jog: the reader sees the first one.
void Jog::repeat(server::Stage& device, const Result<Known>& known) {
  device.post([self = self<Jog>(), &device, known](const StageController& controller, TimePoint) {
    self->over_ = true;
    self->show_repeated(device, controller, known);
  });
}

Result<void> Jog::post_renewal(server::Stage& device, const Result<JogAxes>& axes) {
  if (!axes) return tl::unexpected(axes.error());
  device.post([self = self<Jog>(), axes = request_axes(*axes)](StageController& controller, TimePoint now) {
    if (self->motion_ == 0 || self->over_) return;
    const Result<void> renewed = controller.renew_jog(self->motion_, axes, now);
    // If the jog has ended, the reader receives the outcome instead.
    if (!renewed && renewed.error().reason != Reason::not_found) self->refuse(renewed.error());
  });
  return {};
}

void Jog::finish() { stop({}); }

void Jog::break_off() {
  {
    const std::lock_guard lock(mutex_);
    broken_off_ = true;
    if (jogged_ == nullptr) return;  // no request yet
  }
  stop(kBrokenOff);
}

bool Jog::refuse(const Problem& problem) {
  {
    const std::lock_guard lock(mutex_);
    refused_ = true;
  }
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
