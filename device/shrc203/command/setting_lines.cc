#include "device/shrc203/command/setting_lines.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <chrono>
#include <optional>
#include <utility>
#include <variant>

#include "device/shot/command/command.h"
#include "device/shot/command/reply.h"
#include "device/shot/command/trigger_reply.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/command/trigger.h"

namespace axisgate::shrc203 {
namespace {

using Lines = std::vector<std::string>;

constexpr Duration kSettlingStep = std::chrono::milliseconds(100), kSettlingMax = std::chrono::seconds(255);

std::string on_off(bool on) { return on ? "1" : "0"; }

// The controller's words are written in capitals.
std::string in_capitals(std::string word) {
  for (char& letter : word) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return word;
}

Arguments of_one(int axis) { return Arguments().axes(AxisSet::of(axis)); }

Arguments speed_of_one(int axis, std::int64_t pulses) {
  return of_one(axis).add("u", "F").add("spd", std::to_string(pulses));
}

Result<Lines> only_line(Result<std::string> line) {
  if (!line) return tl::unexpected(std::move(line.error()));
  return Lines{*std::move(line)};
}

Result<Lines> only(std::string_view row, const Arguments& arguments = {}) {
  return only_line(encode(model().row(row), arguments));
}

// Builds the lines for each setting; the numbers are the manual's.
struct LinesFor {
  const State& state;

  // 51) F:; 1 is open loop.
  Result<Lines> operator()(const SetClosedLoop& set) const {
    return only("F:", of_one(set.axis).add("f", on_off(!set.closed)));
  }
  // 52) C:
  Result<Lines> operator()(const SetExcitation& set) const {
    return only("C:", of_one(set.axis).add("c", on_off(set.excited)));
  }
  // 55) S:
  Result<Lines> operator()(const SetDivisions& set) const {
    return only("S:", of_one(set.axis).add("m", std::to_string(set.divisions)));
  }
  Result<Lines> operator()(const SetSpeeds& set) const;
  // 94) B:
  Result<Lines> operator()(const SetOriginSpeeds& set) const {
    const SpeedSetting& speeds = set.speeds;
    return only("B:", of_one(set.axis).speeds(speeds.minimum, speeds.maximum, speeds.acceleration_ms));
  }

  // 48) BO:, 54) BEEP:
  Result<Lines> operator()(const SetDisplay& set) const { return only("BO:", Arguments().add("l", on_off(set.lit))); }
  Result<Lines> operator()(const SetBeep& set) const { return only("BEEP:", Arguments().add("b", on_off(set.on))); }
  Result<Lines> operator()(const SetSettling& set) const;
  // 96) O:
  Result<Lines> operator()(const SetOutputs& set) const {
    return only("O:", Arguments().add("s", std::to_string(set.outputs)));
  }
  Result<Lines> operator()(const SetTrigger& set) const { return only_line(trigger_line(set.trigger)); }
  // 47) SLEEP:
  Result<Lines> operator()(const SetSleep& set) const {
    return only("SLEEP:", Arguments().add("s", on_off(set.sleeping)));
  }
  // 49) MODE:, 50) FMT:
  Result<Lines> operator()(const SetMode& set) const {
    return only("MODE:", Arguments().add("m", in_capitals(set.mode)));
  }
  Result<Lines> operator()(const SetFormat& set) const {
    return only("FMT:", Arguments().add("f", in_capitals(set.format)));
  }

  Result<Lines> operator()(const SetCoordinates& set) const;
  // 63) R:, 64) RC:
  Result<Lines> operator()(const SetOrigin& set) const { return only("R:", Arguments().axes(set.axes)); }
  Result<Lines> operator()(const UnsetOrigin& set) const { return only("RC:", Arguments().axes(set.axes)); }

  // 100) T:M, 46) RESET:
  Result<Lines> operator()(const FireTrigger&) const { return only("T:M"); }
  Result<Lines> operator()(const ResetController&) const { return only("RESET:"); }
};

// Sends only the given values, since the others may belong to a running motion at present. S may never exceed F (manual
// 89)): S is sent before a lower F, and a higher S is sent after its F.
Result<Lines> LinesFor::operator()(const SetSpeeds& set) const {
  const AxisState& present = state.axis(set.axis);
  auto minimum = set.minimum;
  if (minimum && set.maximum && *minimum > *set.maximum) {
    return tl::unexpected(
        Problem{.reason = Reason::out_of_range,
                .message = fmt::format("axis {}: the lowest speed S of {} pulses/s exceeds the highest, F of {}",
                                       set.axis, *minimum, *set.maximum),
                .hint = "set F to S or higher",
                .axis = set.axis});
  }
  if (set.maximum && !minimum && present.minimum_speed.value_or(0) > *set.maximum) minimum = set.maximum;
  const bool first = minimum && (!set.maximum || *minimum <= present.maximum_speed.value_or(0));
  std::vector<std::pair<std::string_view, Arguments>> rows;
  if (first) rows.emplace_back("DS:", speed_of_one(set.axis, *minimum));
  if (set.maximum) rows.emplace_back("DF:", speed_of_one(set.axis, *set.maximum));
  if (minimum && !first) rows.emplace_back("DS:", speed_of_one(set.axis, *minimum));
  if (set.acceleration_ms) rows.emplace_back("DR:", of_one(set.axis).add("r", std::to_string(*set.acceleration_ms)));
  Lines lines;
  for (const auto& [row, arguments] : rows) {
    auto line = encode(model().row(row), arguments);
    if (!line) return tl::unexpected(std::move(line.error()));
    lines.push_back(*std::move(line));
  }
  return lines;
}

// Settling in tenths of a second (manual 56) W:).
Result<Lines> LinesFor::operator()(const SetSettling& set) const {
  const bool in_range = set.settling >= Duration::zero() && set.settling <= kSettlingMax;
  if (!in_range || set.settling % kSettlingStep != Duration::zero()) {
    return fail(in_range ? Reason::not_representable : Reason::out_of_range, "settling is 0 to 255 s in steps of 0.1 s",
                "give a multiple of 0.1 s");
  }
  return only("W:", Arguments().add("w", std::to_string(set.settling / kSettlingStep)));
}

// 45) PSET:, for all its axes at once.
Result<Lines> LinesFor::operator()(const SetCoordinates& set) const {
  AxisSet axes;
  for (const auto& [axis, pulses] : set.pulses) axes.add(axis);
  Arguments arguments = Arguments().axes(axes);
  for (const auto& [axis, pulses] : set.pulses) {
    arguments.add("m", pulses < 0 ? "-" : "+").add("u", "P").add("c", std::to_string(pulses < 0 ? -pulses : pulses));
  }
  return only("PSET:", arguments);
}

std::optional<int> number_in(std::string_view answer) {
  const auto number = parse_integer(answer);
  return number ? std::optional(static_cast<int>(*number)) : std::nullopt;
}

std::optional<bool> switched_on(std::string_view answer) {
  const auto number = parse_integer(answer);
  return number ? std::optional(*number == 1) : std::nullopt;
}

void read_of_axis(std::string_view question, const std::string& answer, AxisSettings& axis) {
  if (question == "?:D") axis.speeds = parse_speed_setting(answer);
  if (question == "?:B") axis.origin_speeds = parse_speed_setting(answer);
  if (question == "?:S") axis.divisions = number_in(answer);
  if (question == "?:F") axis.closed_loop = answer == "0";
  if (question == "?:C") axis.excited = answer == "1";
  if (question == "?:AN") axis.name_on_device = answer;
  if (question == "?:R") axis.scale_resolution = answer;
}

}  // namespace

Result<std::vector<std::string>> lines_for(const Setting& setting, const State& state) {
  return std::visit(LinesFor{state}, setting);
}

// Manual 13), 17), 11), 34), 33), 12), 9), 27), 36), 39), 26), 95), 42), 35), 38), 37).
std::span<const std::string_view> setting_questions() {
  static constexpr std::array<std::string_view, 16> kQuestions = {
      "?:D",  "?:B",    "?:S", "?:F", "?:C", "?:AN",    "?:R",   "?:W",
      "?:BO", "?:BEEP", "?:O", "I:",  "?:T", "?:SLEEP", "?:FMT", "?:MODE"};
  return kQuestions;
}

void read_setting(std::string_view question, std::string_view answer, AxisSet controllable, Settings& settings) {
  const CommandRow& row = model().row(question);
  const auto reply = parse_reply(model(), row, answer, controllable.count());
  if (!reply || reply->kind != Reply::Kind::data) return;
  if (row.reply.ends_with('*')) {
    for (const auto& [axis, field] : by_axis(model(), *reply, controllable)) {
      read_of_axis(question, field, settings.axes[axis]);
    }
  }
  if (question == "?:W") settings.settling = kSettlingStep * number_in(answer).value_or(0);
  if (question == "?:SLEEP") settings.sleeping = switched_on(answer);
  if (question == "?:BO") settings.display_lit = switched_on(answer);
  if (question == "?:BEEP") settings.beep = switched_on(answer);
  if (question == "?:O") settings.outputs = number_in(answer);
  if (question == "I:") settings.inputs = number_in(answer);
  if (question == "?:MODE") settings.mode = std::string(answer);
  if (question == "?:FMT") settings.format = std::string(answer);
  if (question == "?:T") settings.trigger = parse_trigger(answer, model().axes());
}

}  // namespace axisgate::shrc203
