#include "server/rpc/setting_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "device/shrc203/command/codec.h"
#include "device/shrc203/command/reply.h"
#include "device/shrc203/command/trigger.h"
#include "server/rpc/amounts.h"
#include "server/rpc/news.h"
#include "server/rpc/targets.h"

namespace axisgate::rpc {
namespace {

using shrc203::Arguments;
using stage::AxisSet;

constexpr std::int32_t kNanosOfStep = 100'000'000;  // 0.1 s (manual 56))
constexpr std::int64_t kSecondsMax = 255;

std::string_view on_off(bool on) { return on ? "1" : "0"; }

// As the controller's words are written.
std::string in_capitals(std::string word) {
  for (char& letter : word) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return word;
}

// The lines so far, or what is wrong with one.
class Writer {
 public:
  Writer& add(std::string_view row, const Arguments& arguments = {}) {
    if (problem_) return *this;
    auto line = shrc203::encode(shrc203::command_row(row), arguments);
    line ? lines_.push_back(*std::move(line)) : refuse(line.error());
    return *this;
  }
  void refuse(Problem problem) {
    if (!problem_) problem_ = std::move(problem);
  }
  Result<Lines> lines() {
    if (problem_) return tl::unexpected(*std::move(problem_));
    return std::move(lines_);
  }

 private:
  Lines lines_;
  std::optional<Problem> problem_;
};

Arguments of_axis(int axis) { return Arguments().axes(AxisSet::of(axis)); }

Arguments speed_of(int axis, std::int64_t pulses) {
  return of_axis(axis).add("u", "F").add("spd", std::to_string(pulses));
}

// Only what is given is sent: what is not may be a running motion's for now. S may not exceed F at any time (manual
// 89)), so a lower F has S go before it, and a higher S goes behind its F.
void add_speeds(int number, const api::Profile& profile, const stage::AxisState& present, Writer& writer) {
  const auto pulses_of = [&](bool given, const api::Speed& speed) -> std::optional<std::int64_t> {
    if (!given) return {};
    const auto quantity = to_quantity(speed);
    const auto pulses = quantity ? to_pulses_per_second(*quantity, *present.scale) : tl::unexpected(quantity.error());
    if (!pulses) writer.refuse(on_axis(number, pulses.error()));
    return pulses ? std::optional(*pulses) : std::nullopt;
  };
  auto minimum = pulses_of(profile.has_minimum(), profile.minimum());
  const auto maximum = pulses_of(profile.has_maximum(), profile.maximum());
  if (minimum && maximum && *minimum > *maximum) {
    return writer.refuse(on_axis(
        number,
        {.reason = Reason::out_of_range,
         .message = fmt::format("the lowest speed S of {} pulses/s exceeds the highest, F of {}", *minimum, *maximum),
         .hint = "set F to S or higher"}));
  }
  if (maximum && !minimum && present.minimum_speed.value_or(0) > *maximum) minimum = maximum;
  const bool first = minimum && (!maximum || *minimum <= present.maximum_speed.value_or(0));
  if (first) writer.add("DS:", speed_of(number, *minimum));
  if (maximum) writer.add("DF:", speed_of(number, *maximum));
  if (minimum && !first) writer.add("DS:", speed_of(number, *minimum));
  if (profile.acceleration_ms() != 0) {
    writer.add("DR:", of_axis(number).add("r", std::to_string(profile.acceleration_ms())));
  }
}

// B: has no parts: what is not given is sent as it is.
void add_origin_speeds(int number, const api::Profile& profile, const stage::AxisState& present, Writer& writer) {
  stage::AxisState origin = present;
  origin.minimum_speed.reset();
  origin.maximum_speed.reset();
  origin.acceleration_ms.reset();
  if (present.origin_speeds) {
    origin.minimum_speed = present.origin_speeds->minimum;
    origin.maximum_speed = present.origin_speeds->maximum;
    origin.acceleration_ms = present.origin_speeds->acceleration_ms;
  }
  const auto speeds = to_profile(profile, origin);
  if (!speeds) return writer.refuse(on_axis(number, speeds.error()));
  const auto minimum = to_pulses_per_second(speeds->minimum, *present.scale),
             maximum = to_pulses_per_second(speeds->maximum, *present.scale);
  for (const auto& speed : {minimum, maximum}) {
    if (!speed) return writer.refuse(on_axis(number, speed.error()));
  }
  writer.add("B:", of_axis(number).speeds(*minimum, *maximum, speeds->acceleration_ms));
}

// Which it is, and that amounts can be converted there.
Result<int> usable_axis(int number, const stage::State& state) {
  const auto axis = to_axis(number);
  if (!axis) return axis;
  if (const auto good = controllable_axes(AxisSet::of(*axis), state); !good) return tl::unexpected(good.error());
  if (state.axis(*axis).scale) return axis;
  return fail(Reason::link_down, fmt::format("what a pulse of axis {} is has not been read yet", *axis),
              "try again when the device is up");
}

void add_axis(const api::AxisSettings& settings, const stage::State& state, Writer& writer) {
  const auto axis = usable_axis(settings.axis(), state);
  if (!axis) return writer.refuse(axis.error());
  if (!settings.name_on_device().empty() || !settings.scale_resolution().empty()) {
    return writer.refuse({.reason = Reason::invalid_request,
                          .message = "name_on_device and scale_resolution cannot be changed here",
                          .hint = "the controller's memory switches have them",
                          .axis = *axis});
  }
  const stage::AxisState& present = state.axis(*axis);
  if (settings.has_closed_loop()) {
    writer.add("F:", of_axis(*axis).add("f", settings.closed_loop() ? "0" : "1"));
  }
  if (settings.has_excited()) writer.add("C:", of_axis(*axis).add("c", std::string(on_off(settings.excited()))));
  if (settings.has_divisions()) writer.add("S:", of_axis(*axis).add("m", std::to_string(settings.divisions())));
  if (settings.has_speeds()) add_speeds(*axis, settings.speeds(), present, writer);
  if (settings.has_origin_speeds()) add_origin_speeds(*axis, settings.origin_speeds(), present, writer);
}

void add_settling(const google::protobuf::Duration& settling, Writer& writer) {
  const bool valid = settling.seconds() >= 0 && settling.nanos() >= 0 && settling.nanos() < 1'000'000'000;
  const bool in_range =
      valid && settling.seconds() <= kSecondsMax && (settling.seconds() < kSecondsMax || settling.nanos() == 0);
  if (!in_range || settling.nanos() % kNanosOfStep != 0) {
    return writer.refuse({.reason = in_range ? Reason::not_representable : Reason::out_of_range,
                          .message = "settling is 0 to 255 s in steps of 0.1 s",
                          .hint = "give a multiple of 0.1 s"});
  }
  writer.add("W:", Arguments().add("w", std::to_string(settling.seconds() * 10 + settling.nanos() / kNanosOfStep)));
}

void add_trigger(const api::Trigger& trigger, Writer& writer) {
  const std::string axis = std::to_string(trigger.axis()), interval = std::to_string(trigger.interval());
  switch (trigger.target()) {
    case api::Trigger::TARGET_NONE:
      writer.add("T:S");
      return;
    case api::Trigger::TARGET_DRIVE_PULSES:
      writer.add("T:P", Arguments().add("a", axis).add("b", interval));
      return;
    case api::Trigger::TARGET_TIMER:
      writer.add("T:T", Arguments().add("a", interval));
      return;
    case api::Trigger::TARGET_SCALE_PLUS:
    case api::Trigger::TARGET_SCALE_MINUS: {
      const char* sign = trigger.target() == api::Trigger::TARGET_SCALE_PLUS ? "+" : "-";
      writer.add("T:E", Arguments().add("a", axis).add("m", sign).add("b", interval));
      return;
    }
    default:
      writer.refuse({.reason = Reason::invalid_request,
                     .message = "the trigger has no target",
                     .hint = "name one; TARGET_NONE ends it"});
  }
}

// What leaves the state otherwise than a later line of the same request could count on.
bool stands_alone(const std::string& line) {
  return line.starts_with("S:") || line.starts_with("MODE:") || line.starts_with("FMT:");
}

}  // namespace

Result<Lines> lines_of(const api::ChangeSettingsRequest& request, const stage::State& state) {
  const api::Settings& settings = request.settings();
  Writer writer;
  AxisSet axes;
  for (const api::AxisSettings& axis : settings.axes()) {
    add_axis(axis, state, writer);
    const auto number = to_axis(axis.axis());
    if (number && axes.has(*number)) {
      writer.refuse({.reason = Reason::invalid_request,
                     .message = fmt::format("axis {} is named twice", *number),
                     .hint = "name it once"});
    }
    if (number) axes.add(*number);
  }
  if (settings.has_display_lit()) writer.add("BO:", Arguments().add("l", std::string(on_off(settings.display_lit()))));
  if (settings.has_beep()) writer.add("BEEP:", Arguments().add("b", std::string(on_off(settings.beep()))));
  if (settings.has_settling()) add_settling(settings.settling(), writer);
  if (settings.has_outputs()) writer.add("O:", Arguments().add("s", std::to_string(settings.outputs())));
  if (settings.has_trigger()) add_trigger(settings.trigger(), writer);
  if (settings.has_sleeping()) writer.add("SLEEP:", Arguments().add("s", std::string(on_off(settings.sleeping()))));
  if (settings.has_mode()) writer.add("MODE:", Arguments().add("m", in_capitals(settings.mode())));
  if (settings.has_format()) writer.add("FMT:", Arguments().add("f", in_capitals(settings.format())));
  if (settings.has_inputs()) {
    writer.refuse({.reason = Reason::invalid_request,
                   .message = "inputs are set by what is wired to them",
                   .hint = "leave them out"});
  }
  Result<Lines> lines = writer.lines();
  if (lines && lines->empty()) {
    return fail(Reason::invalid_request, "nothing is to be changed", "give a setting with its new value");
  }
  if (lines && lines->size() > 1 && std::ranges::any_of(*lines, stands_alone)) {
    return fail(Reason::invalid_request, "divisions, mode and format are changed alone",
                "ask for each by a call of its own");
  }
  return lines;
}

Result<Lines> lines_of(const api::SetCoordinatesRequest& request, const stage::State& state) {
  AxisSet axes;
  std::map<int, std::int64_t> positions;
  std::optional<api::AxisCoordinate::CoordinateCase> way;
  for (const api::AxisCoordinate& one : request.coordinates()) {
    const auto axis = usable_axis(one.axis(), state);
    if (!axis) return tl::unexpected(axis.error());
    const bool meant =
        one.coordinate_case() == api::AxisCoordinate::kPosition || one.set_origin() || one.unset_origin();
    if (!meant) {
      return fail(Reason::invalid_request, fmt::format("axis {} has no coordinate", *axis),
                  "give `position`, or `set_origin` or `unset_origin` as true");
    }
    if (axes.has(*axis) || way.value_or(one.coordinate_case()) != one.coordinate_case()) {
      return fail(Reason::invalid_request, "each axis once, and all in the same way",
                  "ask for the others by a second call");
    }
    axes.add(*axis);
    way = one.coordinate_case();
    if (way != api::AxisCoordinate::kPosition) continue;
    const auto quantity = to_quantity(one.position());
    if (!quantity) return tl::unexpected(on_axis(*axis, quantity.error()));
    const auto pulses = to_pulses(*quantity, *state.axis(*axis).scale);
    if (!pulses) return tl::unexpected(on_axis(*axis, pulses.error()));
    positions[*axis] = *pulses;
  }
  Writer writer;
  if (way == api::AxisCoordinate::kSetOrigin) return writer.add("R:", Arguments().axes(axes)).lines();
  if (way == api::AxisCoordinate::kUnsetOrigin) return writer.add("RC:", Arguments().axes(axes)).lines();
  if (way != api::AxisCoordinate::kPosition) {
    return fail(Reason::invalid_request, "no coordinate is given", "name axes, and what their places shall be called");
  }
  Arguments arguments = Arguments().axes(axes);
  for (const auto& [axis, pulses] : positions) {
    arguments.add("m", pulses < 0 ? "-" : "+").add("u", "P").add("c", std::to_string(pulses < 0 ? -pulses : pulses));
  }
  return writer.add("PSET:", arguments).lines();
}

const std::vector<std::string_view>& setting_questions() {
  static const std::vector<std::string_view> questions = {
      "?:D",  "?:B",    "?:S", "?:F", "?:C", "?:AN",    "?:R",   "?:W",
      "?:BO", "?:BEEP", "?:O", "I:",  "?:T", "?:SLEEP", "?:FMT", "?:MODE"};
  return questions;
}

namespace {

void fill_speeds(const std::string& answer, api::Profile& profile) {
  const auto speed = shrc203::parse_speed_setting(answer);
  if (!speed) return;
  profile.mutable_minimum()->set_pulses_per_s(speed->minimum);
  profile.mutable_maximum()->set_pulses_per_s(speed->maximum);
  profile.set_acceleration_ms(speed->acceleration_ms);
}

void fill_axis(std::string_view question, const std::string& answer, api::AxisSettings& axis) {
  if (question == "?:D") fill_speeds(answer, *axis.mutable_speeds());
  if (question == "?:B") fill_speeds(answer, *axis.mutable_origin_speeds());
  if (question == "?:S") axis.set_divisions(std::atoi(answer.c_str()));
  if (question == "?:F") axis.set_closed_loop(answer == "0");
  if (question == "?:C") axis.set_excited(answer == "1");
  if (question == "?:AN") axis.set_name_on_device(answer);
  if (question == "?:R") axis.set_scale_resolution(answer);
}

}  // namespace

void fill_setting(std::string_view question, const std::string& answer, const stage::State& state,
                  api::Settings& settings) {
  const int number = std::atoi(answer.c_str());
  if (question == "?:W") {
    settings.mutable_settling()->set_seconds(number / 10);
    settings.mutable_settling()->set_nanos(number % 10 * kNanosOfStep);
  }
  if (question == "?:SLEEP") settings.set_sleeping(number == 1);
  if (question == "?:BO") settings.set_display_lit(number == 1);
  if (question == "?:BEEP") settings.set_beep(number == 1);
  if (question == "?:O") settings.set_outputs(number);
  if (question == "I:") settings.set_inputs(number);
  if (question == "?:MODE") settings.set_mode(answer);
  if (question == "?:FMT") settings.set_format(answer);
  if (question == "?:T") {
    if (const auto trigger = shrc203::parse_trigger(answer)) fill_trigger(*trigger, *settings.mutable_trigger());
  }
  const shrc203::CommandRow& row = shrc203::command_row(question);
  const auto reply = shrc203::parse_reply(row, answer, state.controllable().count());
  if (!row.reply.ends_with('*') || !reply) return;
  for (const auto& [axis, field] : shrc203::by_axis(*reply, state.controllable())) {
    const auto same = [axis = axis](const api::AxisSettings& one) { return one.axis() == axis; };
    auto found = std::ranges::find_if(*settings.mutable_axes(), same);
    if (found == settings.mutable_axes()->end()) {
      settings.add_axes()->set_axis(axis);
      found = std::prev(settings.mutable_axes()->end());
    }
    fill_axis(question, field, *found);
  }
}

void fill_known(const stage::State& state, api::Settings& settings) {
  if (state.outputs) settings.set_outputs(*state.outputs);
  if (state.trigger) fill_trigger(*state.trigger, *settings.mutable_trigger());
}

}  // namespace axisgate::rpc
