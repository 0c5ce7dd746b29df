// Kinds of warnings that a check gives. Each has a name, by which people accept it, and a remedy.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::rml1 {

enum class Warning {
  below_reach,
  below_stock,
  beyond_guideline,
  cut_outside_area,
  damaged,
  deep_pass,
  drags_home,
  drags_tool,
  ends_relative,
  made_for_another_mill,
  no_job,
  no_such_axis,
  open_end,
  out_of_range,
  outside_stock,
  profile_height,
  spindle_off,
  too_fast,
  tool_left_down,
  waits_for_person  // last: kWarnings
};
inline constexpr std::size_t kWarnings = static_cast<std::size_t>(Warning::waits_for_person) + 1;

// Returns the kind's name, which never changes: "deep-pass".
std::string_view name(Warning warning);
// Returns the advice for people, as the end of a sentence: "cut in several passes".
std::string_view remedy(Warning warning);
// Returns nullopt if no warning has that name.
std::optional<Warning> warning_named(std::string_view name);
// Returns "beyond-guideline, below-reach, ...".
std::string all_warning_names();

}  // namespace axisgate::rml1
