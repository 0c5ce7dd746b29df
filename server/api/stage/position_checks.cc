#include "server/api/stage/position_checks.h"

#include <fmt/format.h>

#include <utility>

#include "device/core/escape.h"
#include "device/core/spans.h"

namespace axisgate::api {
namespace {

// Reports whether the connection was interrupted since the controller was last known to have the position, so that it
// may have restarted.
bool was_interrupted(const server::SavedPosition& position, const stage::State& state) {
  const bool line = state.link == stage::LinkState::up || state.link == stage::LinkState::doubtful;
  return !line || !position.frame || position.frame->device_epoch != state.device_epoch;
}

constexpr const char* kAgain = "save it again where it shall be: `SavePosition`";

}  // namespace

Result<void> check_unit(const server::SavedPosition& position, const stage::State& state) {
  if (state.serial_number.empty() || state.serial_number == position.serial_number) return {};
  return fail(Reason::epoch_passed,
              fmt::format("\"{}\" was saved in the controller {}, and this is {}", position.name,
                          position.serial_number, escaped(state.serial_number)),
              kAgain);
}

bool may_be_lost(const server::SavedPosition& position, const stage::State& state) {
  return !check_unit(position, state) || (position.place && was_interrupted(position, state));
}

stage::PositionSlot slot_of(const server::SavedPosition& position) { return {position.place, position.number}; }

Result<std::map<int, std::int64_t>> reported_coordinates(const server::SavedPosition& position,
                                                         const std::string& question,
                                                         const std::vector<std::string>& answers,
                                                         const stage::Kind& kind, const stage::State& state) {
  // One flipped bit would change the place, and a later motion to it would be refused.
  if (answers.size() != 2 || answers[0] != answers[1]) {
    return fail(Reason::line_fault, fmt::format("the controller reported two things of {}", question), "save it again");
  }
  auto coordinates = kind.read_position(slot_of(position), answers[0], state);
  if (!coordinates.empty()) return coordinates;
  return tl::unexpected(Problem{.reason = Reason::device_refused,
                                .message = "the controller saved the position, and does not report its coordinates",
                                .hint = "check its mode: `GetDevice`",
                                .sent = question,
                                .wire_reply = answers[0]});
}

// Manual 129): for a place, the controller reports its present coordinates. It keeps the place as long as the
// connection is not interrupted; if coordinates were set again meanwhile, there is nothing to compare them with. After
// an interruption, and in another run of the daemon, only equal coordinates show that it is the same place, although
// the frame may have changed. A set of coordinates never changes.
std::map<int, std::int64_t> expected_of(const server::SavedPosition& position, const stage::State& state) {
  const bool shifted =
      position.place && !was_interrupted(position, state) && *position.frame != server::frame_of(state);
  return shifted ? std::map<int, std::int64_t>() : position.coordinates;
}

Problem refusal_of(Problem problem, const server::SavedPosition& position, const stage::State& state, TimePoint now) {
  // Only refusals because of the controller's report have `sent`; the others with this reason are about the caller's
  // own epochs.
  if (problem.reason != Reason::epoch_passed || problem.sent.empty()) return problem;
  problem.message = fmt::format("\"{}\" is no longer there: {}", position.name, problem.message);
  if (was_interrupted(position, state)) {
    problem.message +=
        fmt::format("; the controller came back {} ago, and may have restarted{}", for_people(now - state.epoch_began),
                    position.place ? ", which deletes its saved positions" : "");
  }
  problem.hint = kAgain;
  return problem;
}

}  // namespace axisgate::api
