#include "server/api/stage/motions.h"

#include <memory>
#include <utility>

#include "device/stage/envelope.h"
#include "server/api/request/awaited.h"
#include "server/api/request/names.h"
#include "server/api/request/request_texts.h"

namespace axisgate::api {
namespace {

using stage::StageController;

Result<void> check_home(const Turn& turn, const stage::HomeRequest& home) {
  const stage::State& state = turn.controller.state();
  const auto axes = controllable_axes(home.axes, state);
  if (!axes) return tl::unexpected(axes.error());
  const stage::Envelope envelope(turn.device.profile(), state, home.context.who, "");
  for (const int axis : axes->list()) {
    if (const auto good = envelope.check_stage(axis); !good) return good;
  }
  return {};
}

}  // namespace

StageController::OnStarted answering(server::Stage& device, Answer<StartedMotion> answer) {
  return [&device, answer = std::move(answer)](Result<stage::Motion> motion) {
    if (!motion) return answer(tl::unexpected(std::move(motion.error())));
    answer(CurrentMotion(device, *std::move(motion)));
  };
}

void Motions::move(const Call& call, std::string_view device, Result<Move> move, Answer<StartedMotion> answer) const {
  const Asked asked{RequestKind::move, call, find_stage(gateway_, device), fault_of(move)};
  pipeline_.run(
      asked, std::move(answer),
      [move = std::move(move)](const Turn& turn) { return completed(*move, turn.controller.state(), turn.context); },
      [](const Turn& turn, const stage::MoveRequest& request) { return turn.controller.check(request); },
      [](const stage::MoveRequest& request) { return text_of(request); },
      [](const Turn& turn, stage::MoveRequest request, const Answer<StartedMotion>& respond) {
        turn.controller.move(std::move(request), turn.now, answering(turn.device, respond));
      });
}

void Motions::home(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                   Answer<StartedMotion> answer) const {
  begin_home(RequestKind::home, &StageController::home, call, device, axes, std::move(answer));
}

void Motions::return_to_origin(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                               Answer<StartedMotion> answer) const {
  begin_home(RequestKind::return_to_origin, &StageController::return_to_origin, call, device, axes, std::move(answer));
}

void Motions::begin_home(RequestKind kind, Start start, const Call& call, std::string_view device,
                         const Result<stage::AxisSet>& axes, Answer<StartedMotion> answer) const {
  pipeline_.run(
      {kind, call, find_stage(gateway_, device), fault_of(axes)}, std::move(answer),
      [axes = axes.value_or(stage::AxisSet())](const Turn& turn) -> Result<stage::HomeRequest> {
        return stage::HomeRequest{axes, turn.context};
      },
      check_home,
      [kind](const stage::HomeRequest& request) {
        return text_of(kind == RequestKind::home ? "home" : "return to the logical origin", request.axes);
      },
      [start](const Turn& turn, stage::HomeRequest request, const Answer<StartedMotion>& respond) {
        (turn.controller.*start)(std::move(request), turn.now, answering(turn.device, respond));
      });
}

void Motions::scan(const Call& call, std::string_view device, Result<Scan> scan, Answer<StartedMotion> answer) const {
  const Asked asked{RequestKind::scan, call, find_stage(gateway_, device), fault_of(scan)};
  pipeline_.run(
      asked, std::move(answer),
      [scan = std::move(scan)](const Turn& turn) { return completed(*scan, turn.controller.state(), turn.context); },
      [](const Turn& turn, const stage::ScanRequest& request) { return turn.controller.check(request); },
      [](const stage::ScanRequest& request) { return text_of(request); },
      [](const Turn& turn, stage::ScanRequest request, const Answer<StartedMotion>& respond) {
        turn.controller.scan(std::move(request), turn.now, answering(turn.device, respond));
      });
}

void Motions::get(const Call& call, std::string_view motion, Answer<CurrentMotion> answer) const {
  const Result<MotionName> name = find_motion_name(gateway_, motion);
  pipeline_.ask(
      {RequestKind::get_motion, call, device_of(name)}, std::move(answer),
      [&bus = gateway_.events(), id = name ? name->id : 0](const Turn& turn, const Answer<CurrentMotion>& respond) {
        respond(find_motion(bus, turn.device, turn.controller, id));
      });
}

void Motions::list(const Call& call, std::string_view device, Answer<std::vector<CurrentMotion>> answer) const {
  pipeline_.ask({RequestKind::list_motions, call, find_stage(gateway_, device)}, std::move(answer),
                [](const Turn& turn, const Answer<std::vector<CurrentMotion>>& respond) {
                  std::vector<CurrentMotion> all;
                  for (stage::Motion& motion : turn.controller.motions())
                    all.emplace_back(turn.device, std::move(motion));
                  respond(std::move(all));
                });
}

Opened<CurrentMotion> Motions::open(RequestKind kind, const Call& call, std::string_view motion) const {
  const Result<MotionName> name = find_motion_name(gateway_, motion);
  const auto admitted = pipeline_.admit({kind, call, device_of(name)});
  if (!admitted) return tl::unexpected(admitted.error());
  Result<Streams::Place> place = streams_.take(kind, admitted->caller.who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<MotionWatch>(gateway_, *name, *std::move(place));
}

Opened<CurrentMotion> Motions::watch(const Call& call, std::string_view motion) const {
  return open(RequestKind::watch_motion, call, motion);
}

std::function<void()> Motions::wait(const Call& call, std::string_view motion, Duration longest,
                                    const Answer<CurrentMotion>& answer) const {
  const Opened<CurrentMotion> watch = open(RequestKind::wait_motion, call, motion);
  if (!watch) {
    answer(tl::unexpected(watch.error()));
    return {};
  }
  const auto waiting = Awaited<CurrentMotion>::start(
      *watch, [](const CurrentMotion& now) { return stage::is_outcome(now.motion.state); },
      [answer](Result<StartedMotion> found) {
        found ? answer(**std::move(found)) : answer(tl::unexpected(found.error()));
      });
  waiting->limit(gateway_.timeouts(), longest);
  return [left = std::weak_ptr(waiting)] {
    if (const auto still = left.lock()) still->leave();
  };
}

void Motions::cancel(const Call& call, std::string_view motion, Answer<void> answer) const {
  const Result<MotionName> name = find_motion_name(gateway_, motion);
  pipeline_.once({RequestKind::cancel_motion, call, device_of(name)}, std::move(answer),
                 [id = name ? name->id : 0](const Turn& turn, const Answer<void>& respond) {
                   turn.controller.cancel_motion(id, turn.context, turn.now, respond);
                 });
}

}  // namespace axisgate::api
