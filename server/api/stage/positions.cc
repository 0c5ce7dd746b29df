#include "server/api/stage/positions.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "device/link/clock.h"
#include "server/api/stage/position_changes.h"
#include "server/api/stage/position_checks.h"

namespace axisgate::api {
namespace {

using server::SavedPosition;
using server::SavedPositions;

Result<SavedPosition> find_position(const SavedPositions& positions, const std::string& device,
                                    const std::string& name) {
  if (auto position = positions.find(device, name)) return *std::move(position);
  return fail(Reason::not_found, fmt::format("no position is named \"{}\"", name),
              "`ListPositions` lists those there are");
}

// Returns the position's own name; empty if the full name was refused.
std::string own_name(const Result<PositionName>& name) { return name ? name->name : ""; }

// Returns a callback that answers with the motion, or with refusal_of() the position.
stage::StageController::OnStarted answering_of(const Turn& turn, SavedPositions& positions, SavedPosition position,
                                               bool compared, const Answer<StartedMotion>& answer) {
  return [answer, &device = turn.device, &controller = turn.controller, &positions, position = std::move(position),
          compared](Result<stage::Motion> motion) {
    const stage::State& state = controller.state();
    if (!motion) return answer(tl::unexpected(refusal_of(motion.error(), position, state, monotonic_now())));
    if (compared) positions.held_in(position, server::frame_of(state));
    answer(CurrentMotion(device, *std::move(motion)));
  };
}

struct MoveToPosition {
  SavedPosition position;
  stage::GoToPositionRequest request;
};

stage::AxisSet axes_used(const MoveToPosition& move, const stage::State& state) {
  return api::axes_used(move.request, state);
}

}  // namespace

void Positions::save(const Call& call, std::string_view name, const Result<PositionWish>& wish,
                     Answer<std::optional<NamedPosition>> answer) const {
  using Outcome = std::optional<NamedPosition>;
  const Result<PositionName> found = find_position_name(gateway_, name);
  pipeline_.run(
      {RequestKind::save_position, call, device_of(found), fault_of(wish)}, std::move(answer),
      [own = own_name(found), wish = wish.value_or(PositionWish()), &gateway = gateway_,
       &positions = positions_](const Turn& turn) -> Result<Saving> {
        const std::string& device = turn.device.name();
        auto number = positions.take_number(device, own, wish.place, wish.keep_existing);
        if (!number) return tl::unexpected(number.error());
        if (const auto up = turn.controller.check_up(); !up) return tl::unexpected(up.error());
        const stage::Kind& kind = turn.device.kind();
        const auto lines = kind.position_lines({wish.place, **number});
        if (!lines) return fail(Reason::invalid_request, "a controller of this kind keeps no positions");
        const SavedPosition position{device, own, wish.place, **number, {}, {}, turn.context.who, {}, {}};
        return Saving{gateway, positions, kind, *lines, position, *std::move(number), positions.find(device, own)};
      },
      [](const Turn&, const Saving&) { return Result<void>(); },
      [](const Saving& saving) {
        return fmt::format("save the position {}: {}", saving.position.name, saving.lines.save);
      },
      [](const Turn& turn, Saving saving, const Answer<Outcome>& respond) {
        saving.answer = respond;
        begin(std::move(saving), turn);
      },
      [own = own_name(found), &positions = positions_](server::Stage& its_device, const Result<Known>& known,
                                                       const Answer<Outcome>& respond) {
        repeat_done(known, [&](const Result<void>& done) {
          if (!done) return respond(tl::unexpected(done.error()));
          auto position = find_position(positions, its_device.name(), own);
          if (!position) return respond(tl::unexpected(position.error()));
          respond(NamedPosition{*std::move(position), false});
        });
      });
}

void Positions::list(const Call& call, std::string_view device, Answer<std::vector<NamedPosition>> answer) const {
  pipeline_.ask({RequestKind::list_positions, call, find_stage(gateway_, device)}, std::move(answer),
                [&positions = positions_](const Turn& turn, const Answer<std::vector<NamedPosition>>& respond) {
                  std::vector<NamedPosition> all;
                  for (SavedPosition& position : positions.list(turn.device.name())) {
                    const bool emptied = may_be_lost(position, turn.controller.state());
                    all.push_back({std::move(position), emptied});
                  }
                  respond(std::move(all));
                });
}

void Positions::remove(const Call& call, std::string_view name, Answer<void> answer) const {
  const Result<PositionName> found = find_position_name(gateway_, name);
  pipeline_.run(
      {RequestKind::delete_position, call, device_of(found)}, std::move(answer),
      [own = own_name(found), &positions = positions_](const Turn& turn) {
        return find_position(positions, turn.device.name(), own);
      },
      [](const Turn&, const SavedPosition&) { return Result<void>(); },
      [](const SavedPosition& position) { return fmt::format("delete the saved position {}", position.name); },
      [&gateway = gateway_, &positions = positions_](const Turn& turn, SavedPosition position,
                                                     const Answer<void>& respond) {
        begin(Removal{gateway, positions, std::move(position), respond}, turn);
      });
}

void Positions::move_to(const Call& call, std::string_view name, Answer<StartedMotion> answer) const {
  const Result<PositionName> found = find_position_name(gateway_, name);
  pipeline_.run(
      {RequestKind::move_to_position, call, device_of(found)}, std::move(answer),
      [own = own_name(found), &positions = positions_](const Turn& turn) -> Result<MoveToPosition> {
        const stage::State& state = turn.controller.state();
        auto position = find_position(positions, turn.device.name(), own);
        if (!position) return tl::unexpected(position.error());
        if (const auto unit = check_unit(*position, state); !unit) return tl::unexpected(unit.error());
        return MoveToPosition{*position,
                              {position->place, position->number, expected_of(*position, state), turn.context}};
      },
      [](const Turn& turn, const MoveToPosition& move) {
        const Result<void> up = turn.controller.check_up();
        return up ? turn.controller.check(move.request) : up;
      },
      [](const MoveToPosition& move) { return fmt::format("move to the saved position {}", move.position.name); },
      [&positions = positions_](const Turn& turn, MoveToPosition move, const Answer<StartedMotion>& respond) {
        const bool compared = !move.request.expected.empty();
        turn.controller.go_to_position(std::move(move.request), turn.now,
                                       answering_of(turn, positions, std::move(move.position), compared, respond));
      });
}

}  // namespace axisgate::api
