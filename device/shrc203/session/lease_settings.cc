#include "device/shrc203/session/lease_settings.h"

#include <cstdint>
#include <utility>

#include "device/shrc203/limits.h"
#include "device/shrc203/planning/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

std::optional<int> outputs_of(const Command& command) {
  if (command.row->meaning != Meaning::outputs) return {};
  return static_cast<int>(*parse_integer(*command.arguments.first("s")));
}

// Returns the S, F and R that a B: names, in the order of its axes.
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

Task<Result<void>> LeaseSettings::learn(const std::vector<Command>& commands, std::string caller) {
  Result<void> read;
  for (const Command& command : commands) {
    const AxisSet origin = axes_sped({command}, SetsSpeeds::of_origin_return, store_.controllable());
    for (int attempt = 0; attempt < kSettingReadTries; ++attempt) {
      if (outputs_of(command) && !store_.state().outputs) {
        read = co_await reader_.read_outputs(caller);
      } else if (trigger_of(command) && !store_.state().trigger) {
        read = co_await reader_.read_trigger(caller);
      } else if (!store_.origin_speeds_known(origin)) {
        read = co_await reader_.read_origin_speeds(caller);
      } else {
        break;
      }
    }
    if (!read) break;
    if (!store_.origin_speeds_known(origin)) {
      co_return fail(Reason::line_fault, "the speeds of the origin return were read as ones that no axis can have",
                     "check them: `Execute` ?:B");
    }
  }
  co_return read;
}

void LeaseSettings::remember(const RequestContext& context, const Command& command) {
  if (context.lease == 0 || store_.profile().settings_at_lease_end == AtLeaseEnd::kept) return;
  const PendingRestores::Change change{axes_sped({command}, SetsSpeeds::of_motion, store_.controllable()),
                                       axes_sped({command}, SetsSpeeds::of_origin_return, store_.controllable()),
                                       outputs_of(command), trigger_of(command)};
  if (change.empty()) return;
  pending_.remember(context.lease, change, store_.state());
  permission_.settings_changed(context.lease);
}

void note_setting(StateStore& store, const Command& command, const ExchangeResult& result) {
  if (!result.accepted() && !result.in_doubt()) return;
  const auto outputs = outputs_of(command);
  const auto trigger = trigger_of(command);
  if (outputs) store.note_outputs(result.accepted() ? outputs : std::nullopt);
  if (trigger) store.note_trigger(result.accepted() ? trigger : std::nullopt);
  const AxisSet origin = axes_sped({command}, SetsSpeeds::of_origin_return, store.controllable());
  const auto speeds = result.accepted() ? speed_settings_of(command) : std::vector<SpeedSetting>();
  std::size_t place = 0;
  for (const int axis : origin.list()) {
    store.note_origin_speeds(axis, place < speeds.size() ? std::optional(speeds[place]) : std::nullopt);
    ++place;
  }
  if (outputs || trigger) store.publish();
}

}  // namespace axisgate::shrc203
