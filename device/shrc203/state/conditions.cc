#include "device/shrc203/state/conditions.h"

#include <algorithm>
#include <utility>

#include "device/core/guard.h"

namespace axisgate::shrc203 {
namespace {

using stage::Condition;
using stage::ConditionBits;

// Adds the axis to the change; one change lists all axes that it concerns.
void add(Conditions::Changes& changes, Condition condition, int axis, bool begun) {
  const auto same = std::ranges::find_if(
      changes, [&](const ConditionChanged& change) { return change.condition == condition && change.begun == begun; });
  if (same != changes.end()) return same->axes.add(axis);
  changes.push_back({.condition = condition, .axes = AxisSet::of(axis), .begun = begun});
}

}  // namespace

bool Conditions::Compared::doubtful() const {
  return std::ranges::any_of(differing, [](ConditionBits bits) { return bits != 0; });
}

Conditions::Changes Conditions::Compared::compare(const ByAxis& shown, TimePoint now) {
  const bool twice = guarded(Guard::conditions_seen_twice);
  Changes changes;
  for (const auto& [axis, bits] : shown) {
    const auto index = static_cast<std::size_t>(axis - 1);
    ConditionBits differs = 0;
    for (const Condition condition : stage::reported_conditions()) {
      differs |= (bits ^ known[index]) & stage::bit_of(condition);
    }
    const ConditionBits agreed = twice ? differs & differing[index] : differs;
    for (const Condition condition : stage::listed(agreed)) {
      add(changes, condition, axis, (bits & stage::bit_of(condition)) != 0);
    }
    known[index] ^= agreed;
    differing[index] = differs & ~agreed;
  }
  for (ConditionChanged& change : changes) {
    change.before = twice ? before : read;
    change.seen = twice ? read : now;
  }
  before = std::exchange(read, now);
  return changes;
}

Conditions::Changes Conditions::Selected::compare(Condition condition, std::string_view selected, TimePoint now) {
  Changes changes;
  if (selected != known) {
    changes.push_back({.condition = condition,
                       .begun = selected != needed,
                       .value = std::string(selected),
                       .before = read,
                       .seen = now});
  }
  known = selected;
  read = now;
  return changes;
}

// HOST,PROGRAM and HOST,MS are entered by a command, not at the panel (manual 37) ?:MODE).
Conditions::Changes Conditions::mode_read(std::string_view mode, TimePoint now) {
  return mode_.compare(Condition::mode, mode.substr(0, mode.find(',')), now);
}

Conditions::Changes Conditions::format_read(std::string_view format, TimePoint now) {
  return format_.compare(Condition::format, format, now);
}

}  // namespace axisgate::shrc203
