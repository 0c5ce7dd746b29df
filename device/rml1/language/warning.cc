#include "device/rml1/language/warning.h"

#include <algorithm>
#include <array>

namespace axisgate::rml1 {
namespace {

struct Kind {
  Warning warning;
  std::string_view name;
  std::string_view remedy;
};

// In the order of the enumeration, which is that of the names.
constexpr std::array kKinds{
    Kind{Warning::below_reach, "below-reach", "set Z0 higher, or clamp the workpiece higher"},
    Kind{Warning::below_stock, "below-stock", "correct the depth or the thickness; right where a board lies below"},
    Kind{Warning::beyond_guideline, "beyond-guideline", "see that the mill takes this command"},
    Kind{Warning::cut_outside_area, "cut-outside-area", "move the work origin, or the drawing"},
    Kind{Warning::damaged, "damaged", "write the file again"},
    Kind{Warning::deep_pass, "deep-pass", "cut in several passes; right where the material was removed before"},
    Kind{Warning::drags_home, "drags-home", "set the height Z2 of the way home above 0"},
    Kind{Warning::drags_tool, "drags-tool", "set the height Z2 between the cuts above 0"},
    Kind{Warning::ends_relative, "ends-relative", "end the job with PA"},
    Kind{Warning::made_for_another_mill, "made-for-another-mill",
         "make the job for this mill, or send it to the other"},
    Kind{Warning::no_job, "no-job", "send a job in RML-1"},
    Kind{Warning::no_such_axis, "no-such-axis", "leave the axis out, or complete the profile"},
    Kind{Warning::open_end, "open-end", "end the last command with a terminator; see that the file is complete"},
    Kind{Warning::out_of_range, "out-of-range", "see that the nearest value will do"},
    Kind{Warning::outside_stock, "outside-stock", "move the work origin, or take a larger workpiece"},
    Kind{Warning::profile_height, "profile-height", "set the heights Z1 and Z2 in the job (!PZ)"},
    Kind{Warning::spindle_off, "spindle-off", "permit the spindle before the first cut (!MC1)"},
    Kind{Warning::too_fast, "too-fast", "see that the slower speed will do"},
    Kind{Warning::tool_left_down, "tool-left-down", "end the job with the tool up"},
    Kind{Warning::waits_for_person, "waits-for-person", "have somebody at the mill who lets it go on"},
};
static_assert(kKinds.size() == kWarnings);
static_assert(std::ranges::is_sorted(kKinds, {}, &Kind::name));

const Kind& kind(Warning warning) { return kKinds.at(static_cast<std::size_t>(warning)); }

}  // namespace

std::string_view name(Warning warning) { return kind(warning).name; }

std::string_view remedy(Warning warning) { return kind(warning).remedy; }

std::optional<Warning> warning_named(std::string_view name) {
  const auto found = std::ranges::find(kKinds, name, &Kind::name);
  return found == kKinds.end() ? std::nullopt : std::optional(found->warning);
}

std::string all_warning_names() {
  std::string names;
  for (const Kind& one : kKinds) {
    if (!names.empty()) names += ", ";
    names += one.name;
  }
  return names;
}

}  // namespace axisgate::rml1
