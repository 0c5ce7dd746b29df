#include "device/rml1/mill/approach.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "device/rml1/check/check.h"
#include "device/rml1/mill/prefix.h"
#include "device/rml1/sending/commands.h"

namespace axisgate::rml1 {
namespace {

// Returns a number in the notation of RML-1, without an exponent (guideline 2-3), rounded to a millionth of a step.
std::string decimal(double value) {
  std::string text = fmt::format("{:.6f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

// "When Z2 is outside the work area, ... actual Z2 operation stops at the topmost location" (guideline 3-3 !PZ): so the
// tool travels at the top, whatever the height of Z0 is.
constexpr std::string_view kTravelAtTheTop = "!PZ0,8388607;";

tl::unexpected<Problem> refuse_approach(const Prefix& prefix, std::string_view why) {
  const jobs::Place& at = prefix.next()->begins;
  return fail(Reason::invalid_request,
              fmt::format("the job cannot continue at line {}, column {}: {}", at.line, at.column, why),
              "choose an earlier line, or send what is left as a job of its own");
}

Result<void> check_approach(const Prefix& prefix) {
  const Machine& machine = prefix.machine();
  const jobs::Point &tool = machine.tool(), &commanded = machine.commanded();
  if (prefix.leaves().surface)
    return refuse_approach(prefix, "before it the job sets Z0 (!ZO), and where that lies now is not known");
  if (prefix.leaves().rotation)
    return refuse_approach(prefix, "before it the job turns the rotary axis, whose angle is not known");
  if (std::round(commanded.x) != tool.x || std::round(commanded.y) != tool.y) {
    return refuse_approach(prefix, "there the job has left the work area");
  }
  if (machine.tool_lowered() && commanded.z > machine.z1()) {
    return refuse_approach(prefix,
                           "the next command without PU or PD would lower the tool to Z1, and there it is above that");
  }
  if (prefix.height() == Prefix::Height::unknown && commanded.z != machine.z1() && commanded.z != machine.z2()) {
    return refuse_approach(
        prefix, "the height there counts from the top, and without an origin it is not known where Z0 lies below that");
  }
  return {};
}

std::string modes(const Prefix& prefix) {
  const Prefix::Modes& set = prefix.modes();
  std::string words = set.plane_speed ? fmt::format("^VS{};", decimal(*set.plane_speed)) : "";
  words += set.height_speed ? fmt::format("!VZ{};", decimal(*set.height_speed)) : "!VZ;";
  words += "!PZ;";
  if (set.z1 && set.z2) words += fmt::format("!PZ{},{};", decimal(*set.z1), decimal(*set.z2));
  if (set.z1 && !set.z2) words += fmt::format("!PZ{};", decimal(*set.z1));
  if (set.revolutions) words += fmt::format("!RC{};", decimal(*set.revolutions));
  return words;
}

// Returns the commands that start the spindle at the top, before the descent; empty if the spindle is not permitted.
// "Rotation is performed at the time of a command that involves movement" (guideline 5-2): without these commands, a
// permitted spindle would start with the next movement, in the material.
std::string spindle(const Machine& machine) { return machine.spindle_permitted() ? "!MC1;^PR;!ZZ0,0,0;^PA;" : ""; }

// Returns the commands that lower the tool straight down from above the place. PD and PU also set whether later PA and
// PR commands move with the tool down.
std::string descent(const Prefix& prefix) {
  const Machine& machine = prefix.machine();
  const jobs::Point& there = machine.commanded();
  const bool lowered = machine.tool_lowered();
  if (there.z == (lowered ? machine.z1() : machine.z2())) return lowered ? "^PD;" : "^PU;";
  if (prefix.height() == Prefix::Height::machine) return fmt::format("!ZM{};", decimal(prefix.machine_height()));
  if (prefix.height() == Prefix::Height::top) return "";
  return fmt::format("{}!ZZ{},{},{};", lowered ? "^PD;" : "", decimal(there.x), decimal(there.y), decimal(there.z));
}

// Returns the bytes to send before the next command or set. In the middle of a list of coordinates, the name of its
// command is repeated. A name of mode 2 is called with ^, which works in both modes of a mill (guideline 3-1 ^).
std::string before_next(const Prefix& prefix) {
  const auto& [begins, name, first] = *prefix.next();
  const std::string call = name.size() == 2 ? "^" : "";
  return first ? call : call + std::string(name);
}

std::string words_to(const Prefix& prefix, const Profile& profile) {
  const Machine& machine = prefix.machine();
  const jobs::Point& there = machine.commanded();
  std::string words = "!MC0;^PA;" + raise(profile) + std::string(kTravelAtTheTop);
  // !ZM sets the commanded Z to the top, because PU has set it to the Z2 of kTravelAtTheTop.
  words += fmt::format("^PU{},{};!ZM{};", decimal(there.x), decimal(there.y), decimal(profile.top));
  words += modes(prefix) + spindle(machine) + descent(prefix);
  if (prefix.modes().dwell_ms) words += fmt::format("!DW{};", decimal(*prefix.modes().dwell_ms));
  return words + (machine.relative() ? "^PR;" : "");
}

std::set<Warning> warnings_of(const std::vector<Diagnostic>& diagnostics) {
  std::set<Warning> found;
  for (const Diagnostic& one : diagnostics) {
    if (one.warning) found.insert(*one.warning);
  }
  return found;
}

}  // namespace

Result<Approach> approach_to(std::string_view body, std::uint64_t from, const Profile& profile,
                             std::optional<jobs::Origin> origin) {
  const Prefix prefix(body, from, profile, origin);
  if (!prefix.next()) {
    return fail(Reason::invalid_request,
                fmt::format("there is no command at byte {} of {} or after it", from, body.size()),
                "choose an earlier line");
  }
  if (!prefix.has_effect()) return Approach{};
  if (const Result<void> way = check_approach(prefix); !way) return tl::unexpected(way.error());
  return Approach{prefix.next()->begins, words_to(prefix, profile) + before_next(prefix)};
}

std::string continued(std::string_view body, const Approach& approach) {
  return approach.words + std::string(body.substr(approach.at.offset));
}

Result<void> check_unchanged(std::string_view body, const Approach& approach, const Profile& profile,
                             std::optional<jobs::Origin> origin) {
  const Prefix before(body, approach.at.offset, profile, origin), all(body, body.size(), profile, origin);
  const jobs::Leaves &then = before.leaves(), &now = all.leaves();
  const auto changed = [](std::string_view what) {
    return fail(Reason::invalid_request,
                fmt::format("after that place the job {}, and the mill may have done so already", what),
                "cancel it, and send what is left as a job of its own");
  };
  if (now.surface && !then.surface) return changed("sets Z0 (!ZO)");
  if (now.rotation && !then.rotation) return changed("turns the rotary axis");
  if (now.revolutions && !then.revolutions) return changed("sets the spindle speed (!RC)");
  return {};
}

Result<void> check_continued(std::string_view body, const Approach& approach, const Profile& profile,
                             std::optional<jobs::Origin> origin, std::optional<jobs::Stock> stock) {
  const auto check = [&](std::string_view job) {
    Check checked(profile, {.origin = origin, .stock = stock, .others = {}});
    checked.feed(job);
    checked.finish();
    return checked.diagnostics().in_order();
  };
  const auto accepted = warnings_of(check(body));
  for (const Diagnostic& one : check(continued(body, approach))) {
    if (one.severity == Severity::note || (one.warning && accepted.contains(*one.warning))) continue;
    return fail(Reason::invalid_request,
                fmt::format("continued at line {}, column {}, the job has {} that it does not have as a whole: {} [{}]",
                            approach.at.line, approach.at.column,
                            one.severity == Severity::error ? "an error" : "a warning", one.text, one.section),
                "choose another line");
  }
  return {};
}

}  // namespace axisgate::rml1
