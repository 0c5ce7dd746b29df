// What a lease's holder sets for good, speeds (manual 89) D: to 92), 94) B:), outputs (96) O:) and the
// trigger (97) to 101) T:): known before, so that restore.cc sets it back when the lease has ended.
#include <string>
#include <vector>

#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/transaction/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

std::optional<int> outputs_of(const Command& command) {
  if (command.row->meaning != Meaning::outputs) return {};
  return static_cast<int>(*parse_integer(*command.arguments.first("s")));
}

// The S, F and R that a B: names, by its axes in their order.
std::vector<SpeedSetting> speed_settings_of(const Command& command) {
  std::vector<SpeedSetting> speeds;
  for (const auto& [letter, value] : command.arguments.values()) {
    const auto number = parse_integer(value);
    if (!number) continue;
    if (letter == "spds") speeds.push_back({*number, 0, 0});
    if (letter == "spdf" && !speeds.empty()) speeds.back().maximum = *number;
    if (letter == "r" && !speeds.empty()) speeds.back().acceleration_ms = static_cast<int>(*number);
  }
  return speeds;
}

}  // namespace

// What the lines set has to be known before, to be set back. Not D:, which learn_speeds() is for.
Task<Result<void>> Controller::Impl::learn_settings(const std::vector<Command>& commands, std::string caller) {
  Result<void> read;
  for (const Command& command : commands) {
    const AxisSet origin = axes_sped({command}, SetsSpeeds::of_origin_return, state_.controllable());
    for (int attempt = 0; attempt < kSettingReadTries; ++attempt) {
      if (outputs_of(command) && !state_.outputs) {
        read = co_await read_outputs(caller);
      } else if (trigger_of(command) && !state_.trigger) {
        read = co_await read_trigger(caller);
      } else if (known_origin_speeds(origin).size() != static_cast<std::size_t>(origin.count())) {
        read = co_await read_origin_speeds(caller);
      } else {
        break;
      }
    }
    if (!read) break;
    if (known_origin_speeds(origin).size() != static_cast<std::size_t>(origin.count())) {
      co_return fail(Reason::line_fault, "the speeds of the origin return were read as ones that no axis can have",
                     "look at them: axisctl exec ?:B");
    }
  }
  co_return read;
}

// Before it goes out.
void Controller::Impl::remember_settings(const RequestContext& context, const Command& command) {
  if (context.lease == 0 || profile_.settings_at_lease_end == AtLeaseEnd::kept) return;
  const PendingRestores::Change change{axes_sped({command}, SetsSpeeds::of_motion, state_.controllable()),
                                       axes_sped({command}, SetsSpeeds::of_origin_return, state_.controllable()),
                                       outputs_of(command), trigger_of(command)};
  if (change.empty()) return;
  pending_restores_.remember(context.lease, change, state_);
  permission_.settings_changed(context.lease);
}

// After its answer; where that was lost it may have been taken.
void Controller::Impl::note_setting(const Command& command, const ExchangeResult& result) {
  if (!result.accepted() && !result.in_doubt()) return;
  const auto outputs = outputs_of(command);
  const auto trigger = trigger_of(command);
  if (outputs) state_.outputs = result.accepted() ? outputs : std::nullopt;
  if (trigger) state_.trigger = result.accepted() ? trigger : std::nullopt;
  const AxisSet origin = axes_sped({command}, SetsSpeeds::of_origin_return, state_.controllable());
  const auto speeds = result.accepted() ? speed_settings_of(command) : std::vector<SpeedSetting>();
  std::size_t place = 0;
  for (const int axis : origin.list()) {
    note_origin_speeds(axis, place < speeds.size() ? std::optional(speeds[place]) : std::nullopt);
    ++place;
  }
  if (outputs || trigger) publish_state();
}

}  // namespace axisgate::shrc203
