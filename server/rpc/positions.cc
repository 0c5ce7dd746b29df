#include "server/rpc/positions.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "device/core/escape.h"
#include "server/access/spans.h"
#include "server/rpc/call.h"
#include "server/rpc/news.h"

namespace axisgate::rpc {
namespace {

constexpr std::string_view kPositions = "/positions/";

// The controller was out of sight since it was last known to hold it, so that it may have restarted.
bool lost_sight(const server::SavedPosition& position, const stage::State& state) {
  const bool line = state.link == stage::LinkState::up || state.link == stage::LinkState::doubtful;
  return !line || !position.frame || position.frame->device_epoch != state.device_epoch;
}

std::string again(const server::SavedPosition& position) {
  return fmt::format("save it again where it shall be: axisctl save {}{}", position.name,
                     position.place ? "" : " --coordinates");
}

}  // namespace

Result<PositionName> find_position_name(const server::Gateway& gateway, std::string_view name) {
  const std::size_t split = name.find(kPositions);
  const std::string_view own = split == std::string_view::npos ? "" : name.substr(split + kPositions.size());
  if (!server::is_position_name(own)) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a position", escaped(name)),
                fmt::format("write \"devices/stage/positions/sample\"; a name has 1 to {} letters, digits, '-' and '_'",
                            server::SavedPositions::kNameMax));
  }
  const Result<server::Device*> device = find_device(gateway, name.substr(0, split));
  if (!device) return tl::unexpected(device.error());
  return PositionName{*device, std::string(own)};
}

Result<server::SavedPosition> find_position(const server::SavedPositions& positions, const PositionName& name) {
  if (auto position = positions.find(name.device->name(), name.name)) return *std::move(position);
  return fail(Reason::not_found, fmt::format("no position is named \"{}\"", name.name),
              "`axisctl positions` lists those that there are");
}

Result<void> check_unit(const server::SavedPosition& position, const stage::State& state) {
  if (state.serial_number.empty() || state.serial_number == position.serial_number) return {};
  return fail(Reason::epoch_passed,
              fmt::format("\"{}\" was saved in the controller {}, and this is {}", position.name,
                          position.serial_number, escaped(state.serial_number)),
              again(position));
}

api::Position to_proto(const server::SavedPosition& position, const stage::State& state) {
  api::Position proto;
  proto.set_name(fmt::format("devices/{}{}{}", position.device, kPositions, position.name));
  proto.set_kind(position.place ? api::POSITION_KIND_PLACE : api::POSITION_KIND_COORDINATES);
  proto.set_number(position.number);
  for (const auto& [axis, pulses] : position.coordinates) {
    api::PositionCoordinate& coordinate = *proto.add_coordinates();
    coordinate.set_axis(axis);
    coordinate.set_pulses(pulses);
  }
  *proto.mutable_save_time() = to_proto(server::WallTime(position.saved));
  proto.set_who(position.who);
  proto.set_emptied(!check_unit(position, state) || (position.place && lost_sight(position, state)));
  return proto;
}

stage::PositionSlot slot_of(const server::SavedPosition& position) { return {position.place, position.number}; }

Result<std::map<int, std::int64_t>> coordinates_told(const server::SavedPosition& position, const std::string& question,
                                                     const std::vector<std::string>& answers, const stage::Kind& kind,
                                                     const stage::State& state) {
  // One flipped bit would make another place of it, which would be refused later.
  if (answers.size() != 2 || answers[0] != answers[1]) {
    return fail(Reason::line_fault, fmt::format("the controller told two things of {}", question), "save it again");
  }
  auto coordinates = kind.read_position(slot_of(position), answers[0], state);
  if (!coordinates.empty()) return coordinates;
  return tl::unexpected(Problem{.reason = Reason::device_refused,
                                .message = "the controller saved the position, and does not tell its coordinates",
                                .hint = "look at its mode: axisctl status",
                                .sent = question,
                                .wire_reply = answers[0]});
}

// Manual 129): of a place it tells what its coordinates are by now. As long as the controller was never out of sight,
// it holds the place; where its coordinates were set anew meanwhile, nothing is left to compare them with. After it was
// out of sight, and in another run of the daemon, it is the same place only where it tells the same coordinates:
// whether the frame is the same then, too, nobody knows. A set of coordinates stays as it is.
std::map<int, std::int64_t> expected_of(const server::SavedPosition& position, const stage::State& state) {
  const bool shifted = position.place && !lost_sight(position, state) && *position.frame != server::frame_of(state);
  return shifted ? std::map<int, std::int64_t>() : position.coordinates;
}

Problem refusal_of(Problem problem, const server::SavedPosition& position, const stage::State& state, TimePoint now) {
  // What the controller told stands in no other refusal of that reason: those are of the caller's own epochs.
  if (problem.reason != Reason::epoch_passed || problem.sent.empty()) return problem;
  problem.message = fmt::format("\"{}\" is not there any more: {}", position.name, problem.message);
  if (lost_sight(position, state)) {
    problem.message +=
        fmt::format("; the controller came back {} ago, and may have restarted{}",
                    server::for_people(now - state.epoch_began), position.place ? ", which empties its places" : "");
  }
  problem.hint = again(position);
  return problem;
}

}  // namespace axisgate::rpc
