#include "server/rpc/position_service.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "server/events/wall_time.h"
#include "server/rpc/call.h"
#include "server/rpc/news.h"
#include "server/rpc/positions.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

using server::SavedPosition;
using server::SavedPositions;
using stage::ExecuteEvent;
using stage::StageController;

Result<void> check_up(const stage::State& state) {
  if (state.link == stage::LinkState::up || state.link == stage::LinkState::doubtful) return {};
  return fail(Reason::link_down, "the device is not up: " + state.link_problem, "try again when it is up");
}

Problem no_positions() {
  return {.reason = Reason::invalid_request, .message = "a controller of this kind keeps no positions"};
}

Result<bool> is_place(api::PositionKind kind) {
  if (kind == api::POSITION_KIND_COORDINATES) return false;
  if (kind == api::POSITION_KIND_UNSPECIFIED || kind == api::POSITION_KIND_PLACE) return true;
  return fail(Reason::invalid_request, fmt::format("there is no kind {} of positions", static_cast<int>(kind)));
}

// What writes waits for the disk: on the readers' thread, where no line waits for it.
template <class Task>
void away_from_the_lines(server::Gateway& gateway, Task task) {
  gateway.after(Duration::zero(), std::move(task));
}

// One position on its way to a name.
struct Saving {
  UnaryCall<api::SavePositionResponse>::Handle call;
  const stage::Kind& kind;
  stage::PositionLines lines;
  server::Gateway& gateway;
  SavedPositions& positions;
  SavedPosition position;
  SavedPositions::Number number;        // taken until all is over
  std::optional<SavedPosition> before;  // what had the name
  std::vector<std::string> answers;     // to SET, GET and GET

  Result<void> read(const ExecuteEvent& ended, const stage::State& state);
  void refuse(const Problem& problem) const;
};
using SavingPtr = std::shared_ptr<Saving>;

Result<void> Saving::read(const ExecuteEvent& ended, const stage::State& state) {
  if (ended.problem && ended.problem->reason == Reason::not_found) {
    return fail(Reason::device_refused, "the controller took the position, and does not hold it",
                "look at its mode: axisctl status");
  }
  if (ended.problem) return tl::unexpected(*ended.problem);
  auto coordinates = coordinates_told(position, lines.tell, {answers.begin() + 1, answers.end()}, kind, state);
  if (!coordinates) return tl::unexpected(coordinates.error());
  position.coordinates = *std::move(coordinates);
  position.saved = server::calendar_now();
  position.serial_number = state.serial_number;
  position.frame = server::frame_of(state);
  return {};
}

void Saving::refuse(const Problem& problem) const {
  const bool line_failed = problem.reason == Reason::reply_timed_out || problem.reason == Reason::line_fault ||
                           problem.reason == Reason::link_down;
  // The number that was its own may hold the new position by now.
  if (before && (line_failed || !answers.empty())) positions.held_in(*before, {});
  call->refuse(problem);
}

void keep(const SavingPtr& saving, const stage::State& state) {
  away_from_the_lines(saving->gateway, [saving, state] {
    if (const Result<void> kept = saving->positions.keep(saving->position); !kept) return saving->refuse(kept.error());
    saving->call->answer(
        [&](api::SavePositionResponse& answer) { *answer.mutable_position() = to_proto(saving->position, state); });
  });
}

// Sent and read back with nobody else's lines between.
void save(const SavingPtr& saving, const stage::RequestContext& asked, StageController& controller, TimePoint now) {
  const stage::PositionLines& lines = saving->lines;
  controller.execute({{lines.save, lines.tell, lines.tell}, asked}, now,
                     [saving, &controller](const ExecuteEvent& event) {
                       if (event.kind == ExecuteEvent::Kind::reply) saving->answers.push_back(event.answer);
                       if (event.kind != ExecuteEvent::Kind::ended) return;
                       const Result<void> read = saving->read(event, controller.state());
                       read ? keep(saving, controller.state()) : saving->refuse(read.error());
                     });
}

// One on its way to none.
struct Removal {
  UnaryCall<api::DeletePositionResponse>::Handle call;
  server::Device& device;
  server::Gateway& gateway;
  SavedPositions& positions;
  SavedPosition position;
  stage::PositionLines lines;
  stage::RequestContext asked;

  void refuse(const Problem& problem) const { call->refuse(problem); }
};
using RemovalPtr = std::shared_ptr<Removal>;

// The name, where it still means that position.
void forget(const RemovalPtr& removal) {
  away_from_the_lines(removal->gateway, [removal] {
    const SavedPosition& position = removal->position;
    const auto now = removal->positions.find(position.device, position.name);
    const bool still = now && now->place == position.place && now->number == position.number;
    const auto forgotten = still ? removal->positions.forget(position.device, position.name) : Result<void>();
    if (!forgotten) return removal->refuse(forgotten.error());
    removal->call->answer([](api::DeletePositionResponse&) {});
  });
}

void remove(const RemovalPtr& removal, StageController& controller, TimePoint now) {
  controller.execute({{removal->lines.forget}, removal->asked}, now, [removal](const ExecuteEvent& event) {
    if (event.kind != ExecuteEvent::Kind::ended) return;
    event.problem ? removal->refuse(*event.problem) : forget(removal);
  });
}

// Whether DEL is taken where nothing is, the manual does not say (127), 132)); so that is asked first.
void remove_if_there(const RemovalPtr& removal, StageController& controller, TimePoint now) {
  controller.execute({{removal->lines.tell}, removal->asked}, now, [removal](const ExecuteEvent& event) {
    if (event.kind != ExecuteEvent::Kind::ended) return;
    if (event.problem && event.problem->reason == Reason::not_found) return forget(removal);
    if (event.problem) return removal->refuse(*event.problem);
    removal->device.post([removal](StageController& same, TimePoint then) { remove(removal, same, then); });
  });
}

// Answers with the motion, or says what has become of the position.
StageController::OnStarted tell_started(UnaryCall<api::MoveToPositionResponse>::Handle call, server::Device& device,
                                        SavedPositions& positions, SavedPosition position, bool compared,
                                        StageController& controller) {
  return [call = std::move(call), &device, &positions, position = std::move(position), compared,
          &controller](const Result<stage::Motion>& motion) {
    const stage::State& state = controller.state();
    if (!motion) {
      call->refuse(refusal_of(motion.error(), position, state, monotonic_now()));
      return;
    }
    if (compared) positions.held_in(position, server::frame_of(state));
    call->answer([&](api::MoveToPositionResponse& answer) {
      *answer.mutable_motion() = to_proto(device.name(), *motion, device.motion_revision(motion->id));
    });
  };
}

}  // namespace

grpc::ServerUnaryReactor* PositionService::SavePosition(grpc::CallbackServerContext* context,
                                                        const api::SavePositionRequest* request,
                                                        api::SavePositionResponse* response) {
  const auto call = UnaryCall<api::SavePositionResponse>::start(response);
  const Result<PositionName> name = find_position_name(gateway_, request->name());
  if (!name) return call->refuse(name.error());
  const Result<bool> place = is_place(request->kind());
  if (!place) return call->refuse(place.error());
  const Result<stage::RequestContext> asked = mutation_context(*context, request->context());
  if (!asked) return call->refuse(asked.error());
  name->device->post([call, name = *name, place = *place, only_new = request->keep_existing(),
                      validate_only = request->validate_only(), asked = *asked, &gateway = gateway_,
                      &positions = positions_](StageController& controller, TimePoint now) {
    const std::string& device = name.device->name();
    auto number = positions.take_number(device, name.name, place, only_new);
    if (!number) return static_cast<void>(call->refuse(number.error()));
    if (const auto up = check_up(controller.state()); !up) return static_cast<void>(call->refuse(up.error()));
    const stage::Kind& kind = name.device->kind();
    const auto lines = kind.position_lines({place, **number});
    if (!lines) return static_cast<void>(call->refuse(no_positions()));
    if (validate_only) return call->answer([](api::SavePositionResponse&) {});
    const SavedPosition position{device, name.name, place, **number, {}, {}, asked.who, {}, {}};
    const SavingPtr saving(new Saving{
        call, kind, *lines, gateway, positions, position, *std::move(number), positions.find(device, name.name), {}});
    save(saving, asked, controller, now);
  });
  return call.get();
}

grpc::ServerUnaryReactor* PositionService::ListPositions(grpc::CallbackServerContext*,
                                                         const api::ListPositionsRequest* request,
                                                         api::ListPositionsResponse* response) {
  const auto call = UnaryCall<api::ListPositionsResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  (*device)->post([call, &device = **device, &positions = positions_](StageController& controller, TimePoint) {
    call->answer([&](api::ListPositionsResponse& answer) {
      for (const SavedPosition& position : positions.list(device.name())) {
        *answer.add_positions() = to_proto(position, controller.state());
      }
    });
  });
  return call.get();
}

grpc::ServerUnaryReactor* PositionService::DeletePosition(grpc::CallbackServerContext* context,
                                                          const api::DeletePositionRequest* request,
                                                          api::DeletePositionResponse* response) {
  const auto call = UnaryCall<api::DeletePositionResponse>::start(response);
  const Result<PositionName> name = find_position_name(gateway_, request->name());
  if (!name) return call->refuse(name.error());
  const Result<stage::RequestContext> asked = mutation_context(*context, request->context());
  if (!asked) return call->refuse(asked.error());
  name->device->post([call, name = *name, asked = *asked, validate_only = request->validate_only(), &gateway = gateway_,
                      &positions = positions_](StageController& controller, TimePoint now) {
    const auto position = find_position(positions, name);
    if (!position) return static_cast<void>(call->refuse(position.error()));
    const auto allowed = controller.check_use(asked, controller.state().controllable());
    if (!allowed) return static_cast<void>(call->refuse(allowed.error()));
    if (validate_only) return call->answer([](api::DeletePositionResponse&) {});
    const auto lines = name.device->kind().position_lines(slot_of(*position));
    const RemovalPtr removal(
        new Removal{call, *name.device, gateway, positions, *position, lines.value_or(stage::PositionLines{}), asked});
    // The number may be another position's in the controller that is here now.
    const bool here = lines && check_unit(*position, controller.state());
    here ? remove_if_there(removal, controller, now) : forget(removal);
  });
  return call.get();
}

grpc::ServerUnaryReactor* PositionService::MoveToPosition(grpc::CallbackServerContext* context,
                                                          const api::MoveToPositionRequest* request,
                                                          api::MoveToPositionResponse* response) {
  const auto call = UnaryCall<api::MoveToPositionResponse>::start(response);
  const Result<PositionName> name = find_position_name(gateway_, request->name());
  if (!name) return call->refuse(name.error());
  const Result<stage::RequestContext> asked = motion_context(*context, request->context(), access_);
  if (!asked) return call->refuse(asked.error());
  name->device->post([call, name = *name, asked = *asked, validate_only = request->validate_only(),
                      &positions = positions_](StageController& controller, TimePoint now) {
    const stage::State& state = controller.state();
    const auto position = find_position(positions, name);
    if (!position) return static_cast<void>(call->refuse(position.error()));
    if (const auto unit = check_unit(*position, state); !unit) return static_cast<void>(call->refuse(unit.error()));
    const stage::GoToPositionRequest move{position->place, position->number, expected_of(*position, state), asked};
    if (!validate_only) {
      const bool compared = !move.expected.empty();
      return controller.go_to_position(move, now,
                                       tell_started(call, *name.device, positions, *position, compared, controller));
    }
    Result<void> checked = check_up(state);
    if (checked) checked = controller.check(move);
    if (!checked) return static_cast<void>(call->refuse(checked.error()));
    call->answer([](api::MoveToPositionResponse&) {});
  });
  return call.get();
}

}  // namespace axisgate::rpc
