#include "clients/axisctl/print.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "clients/axisctl/condition_text.h"
#include "clients/axisctl/mill/mill_text.h"
#include "clients/cpp/src/failure.h"

namespace axisgate::axisctl {
namespace {

void write(std::FILE* stream, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stream);
  std::fputc('\n', stream);
  std::fflush(stream);
}

// Returns the name without the prefix, or the number: a newer daemon may send values that have no name here.
std::string without_prefix(const std::string& name, std::string_view prefix, int number) {
  return name.empty() ? fmt::format("({})", number) : name.substr(prefix.size());
}

std::string describe_motion(const v1::Motion& motion) {
  std::string text =
      fmt::format("motion {} ({}) {}", last_part(motion.name()), kind_name(motion.kind()), state_name(motion.state()));
  if (motion.has_problem()) {
    text += fmt::format(": {}: {}", client::reason_name(motion.problem().reason()), motion.problem().message());
  }
  return text;
}

std::string describe_progress(const v1::PathProgress& progress) {
  switch (progress.step()) {
    case v1::PathProgress::STEP_SENT:
      return fmt::format("segment {} sent: {}", progress.segment(), progress.wire_reply());
    case v1::PathProgress::STEP_STARTED:
      return fmt::format("segment {} started", progress.segment());
    case v1::PathProgress::STEP_DONE:
      return fmt::format("segment {} done", progress.segment());
    case v1::PathProgress::STEP_UNDERRUN:
      return fmt::format("segment {} came too late: the stage halted before it", progress.segment());
    default:
      return fmt::format("segment {}", progress.segment());
  }
}

std::string describe_link(const v1::LinkChange& link) {
  return link.why().empty() ? fmt::format("line {}", link_name(link.state()))
                            : fmt::format("line {}: {}", link_name(link.state()), link.why());
}

std::string describe_stop(const v1::StopRequested& stop) {
  if (stop.axes().empty()) {
    return fmt::format("abort requested by {}",
                       stop.caller().name().empty() ? "an unknown caller" : stop.caller().name());
  }
  return fmt::format("{} of axes {} requested by {}{}", stop.emergency() ? "emergency stop" : "stop",
                     fmt::join(stop.axes(), ", "),
                     stop.caller().name().empty() ? "an unknown caller" : stop.caller().name(),
                     stop.count() > 1 ? fmt::format(", {} times while nothing moved", stop.count()) : "");
}

std::string axes_text(const google::protobuf::RepeatedField<std::int32_t>& axes) {
  return fmt::format("{} {}", axes.size() == 1 ? "axis" : "axes", fmt::join(axes, ", "));
}

std::string describe_stop_change(const v1::StopChange& stop) {
  const std::string title = fmt::format("{} {} of {} by {}", stop.emergency() ? "emergency stop" : "stop",
                                        last_part(stop.name()), axes_text(stop.axes()), names_text(stop.callers()));
  switch (stop.state()) {
    case v1::StopChange::STATE_OPEN:
      return title + " stays open: nobody has seen the axes obey it, and it is repeated";
    case v1::StopChange::STATE_CONFIRMED: {
      std::string text = fmt::format("{} confirmed after {}", title, duration_text(stop.elapsed_time()));
      for (const v1::AxisRest& rest : stop.rests()) {
        text += fmt::format(", axis {} at {} pulses", rest.axis(), rest.position_pulses());
      }
      return text;
    }
    case v1::StopChange::STATE_REPLACED:
      return fmt::format("{} replaced by stop {}", title, last_part(stop.replaced_by()));
    case v1::StopChange::STATE_WITHDRAWN:
      return fmt::format("{} withdrawn by {}; nobody has seen the axes obey it", title, stop.withdrawn_by().name());
    default:
      return title;
  }
}

std::string describe_latch(const v1::EmergencyLatchChange& change) {
  return change.latched() ? fmt::format("latched by the emergency stop of {}: nothing moves until `axisctl clear`",
                                        change.caller().name())
                          : fmt::format("the emergency stop was cleared by {}", change.caller().name());
}

std::string describe_foreign(const v1::ForeignMotion& motion) {
  return fmt::format("FOREIGN_MOTION: axes {} move without a request to the gateway", fmt::join(motion.axes(), ", "));
}

std::string describe_condition(const v1::ConditionChange& change) {
  using google::protobuf::util::TimeUtil;
  const std::string seen = TimeUtil::ToString(change.seen_time());
  return fmt::format(
      "{}, {}", condition_text(change.condition(), change.axes(), change.begun(), change.value()),
      change.has_before_time() ? between_text(TimeUtil::ToString(change.before_time()), seen) : found_text(seen));
}

std::string describe_switches(const v1::SwitchesChanged& change) {
  std::vector<std::string> parts;
  for (const v1::SwitchChange& one : change.changes()) {
    parts.push_back(fmt::format("{},{} from {} to {}", one.item(), one.number(), one.before(), one.after()));
  }
  if (change.unknown()) parts.emplace_back("other changes are unknown");
  return fmt::format("memory switches changed by {}: {}",
                     change.caller().name().empty() ? "an unknown caller" : change.caller().name(),
                     fmt::join(parts, "; "));
}

std::string describe_notice(const v1::ProgramNotice& notice) {
  const auto* what = notice.kind() == v1::ProgramNotice::KIND_ENDED ? "a program has ended (COMP)"
                                                                    : "a program gave a trigger pulse (TRIG)";
  return notice.count() > 1 ? fmt::format("{}, {} times", what, notice.count()) : what;
}

std::string describe_start(const v1::DaemonStarted& started) {
  return started.after_unclean_end() ? "started; it had not ended in order, so the events just before may be incomplete"
                                     : "started";
}

}  // namespace

std::string on_one_line(std::string_view text) {
  std::string clean(text);
  std::replace_if(
      clean.begin(), clean.end(), [](char byte) { return static_cast<unsigned char>(byte) < 0x20 || byte == 0x7f; },
      ' ');
  return clean;
}

void print_line(std::string_view text) { write(stdout, text); }

void print_json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  if (!google::protobuf::util::MessageToJsonString(message, &json, options).ok()) {
    throw Failure{kFailed, "INTERNAL", "the daemon sent text that is not UTF-8", "leave out --json"};
  }
  print_line(json);
}

void print_failure(const Failure& failure) {
  std::string line = fmt::format("axisctl: {}: {}", failure.reason, failure.message);
  if (!failure.hint.empty()) line += fmt::format(" ({})", failure.hint);
  write(stderr, on_one_line(line));
}

void print_note(std::string_view message) { write(stderr, on_one_line(fmt::format("axisctl: {}", message))); }

std::string axis_label(const v1::Axis& axis) {
  return "axis " + (axis.name().empty() ? std::to_string(axis.number()) : axis.name());
}

Unit core_unit(v1::Unit unit) {
  switch (unit) {
    case v1::UNIT_NANOMETERS:
      return Unit::nanometers;
    case v1::UNIT_MICROMETERS:
      return Unit::micrometers;
    case v1::UNIT_MILLIMETERS:
      return Unit::millimeters;
    case v1::UNIT_DEGREES:
      return Unit::degrees;
    default:
      return Unit::pulses;
  }
}

std::string position_text(const v1::Axis& axis) {
  const bool turned = !axis.position_in_turn().empty() && axis.position_in_turn() != axis.position();
  const std::string in_turn = turned ? fmt::format(" ({} deg in the turn)", axis.position_in_turn()) : "";
  if (!axis.position().empty()) {
    return fmt::format("{} {}{}", axis.position(), symbol(core_unit(axis.unit())), in_turn);
  }
  if (axis.has_position_pulses()) return fmt::format("{} pulse", axis.position_pulses());
  return "unknown";
}

std::string position_text(const v1::Axis& axis, std::int64_t pulses) {
  const Unit unit = core_unit(axis.unit());
  if (const Result<Decimal> per_pulse = parse_decimal(axis.per_pulse())) {
    const Result<Decimal> position = from_pulses(pulses, unit, Scale{*per_pulse, axis.rotary()});
    if (position) return fmt::format("{} {}", to_string(*position), symbol(unit));
  }
  return fmt::format("{} pulse", pulses);
}

std::string place_text(const v1::Axis& axis, std::int64_t pulses) {
  return fmt::format("{} at {}", axis_label(axis), position_text(axis, pulses));
}

std::string speed_text(const v1::Speed& speed) {
  switch (speed.amount_case()) {
    case v1::Speed::kPulsesPerS:
      return fmt::format("{} pulse/s", speed.pulses_per_s());
    case v1::Speed::kNmPerS:
      return speed.nm_per_s() + " nm/s";
    case v1::Speed::kUmPerS:
      return speed.um_per_s() + " um/s";
    case v1::Speed::kMmPerS:
      return speed.mm_per_s() + " mm/s";
    case v1::Speed::kDegreesPerS:
      return speed.degrees_per_s() + " deg/s";
    case v1::Speed::kFloating:  // only in requests
    case v1::Speed::AMOUNT_NOT_SET:
      break;
  }
  return "?";
}

std::string pins_text(const v1::Pins& pins, std::string_view name) {
  std::string on;
  for (const int pin : pins.on()) on += fmt::format("{}{}{}", on.empty() ? "" : " ", name, pin);
  return on.empty() ? "none" : on;
}

std::string names_text(const google::protobuf::RepeatedPtrField<v1::Caller>& callers) {
  std::string names;
  for (const v1::Caller& caller : callers) names += (names.empty() ? "" : ", ") + caller.name();
  return names;
}

std::string mode_text(v1::Mode mode) {
  if (mode == v1::MODE_UNSPECIFIED) return "";
  std::string text = v1::Mode_Name(mode);
  if (text.empty()) return std::to_string(mode);
  text.erase(0, std::string_view("MODE_").size());
  std::ranges::replace(text, '_', ',');
  return text;
}

std::string format_text(v1::CommandFormat format) {
  if (format == v1::COMMAND_FORMAT_UNSPECIFIED) return "";
  const std::string text = v1::CommandFormat_Name(format);
  return text.empty() ? std::to_string(format) : text.substr(std::string_view("COMMAND_FORMAT_").size());
}

std::int64_t milliseconds(const google::protobuf::Duration& duration) {
  return google::protobuf::util::TimeUtil::DurationToMilliseconds(duration);
}

std::string trigger_text(const v1::Trigger& trigger) {
  switch (trigger.target()) {
    case v1::Trigger::TARGET_NONE:
      return "none";
    case v1::Trigger::TARGET_TIMER:
      return fmt::format("every {} s", to_string(Decimal{milliseconds(trigger.period()) / 10, 2}));
    case v1::Trigger::TARGET_DRIVE_PULSES:
      return fmt::format("every {} drive pulses of axis {}", trigger.distance().pulses(), trigger.axis());
    case v1::Trigger::TARGET_SCALE_PLUS:
      return fmt::format("every {} scale pulses of axis {} in direction +", trigger.scale_pulses(), trigger.axis());
    case v1::Trigger::TARGET_SCALE_MINUS:
      return fmt::format("every {} scale pulses of axis {} in direction -", trigger.scale_pulses(), trigger.axis());
    default:
      return "?";
  }
}

std::string scan_text(const v1::Axis& axis, const v1::Scan& scan) {
  std::string text = fmt::format("{} ran from {} to {}", axis_label(axis), position_text(axis, scan.run_from_pulses()),
                                 position_text(axis, scan.run_to_pulses()));
  if (scan.has_expected_triggers() && scan.has_expected_triggers_in_range()) {
    text += fmt::format("; {} trigger pulses expected in the range, {} in all", scan.expected_triggers_in_range(),
                        scan.expected_triggers());
  } else {
    text += "; expected trigger pulses unknown";
  }
  if (!scan.has_observed_triggers()) return text + "; observed trigger pulses unknown";
  return text + fmt::format("; {} computed from the observed displacement", scan.observed_triggers());
}

std::string positions_text(const v1::Device& device) {
  std::vector<std::string> parts;
  for (const v1::Axis& axis : device.axes()) {
    if (axis.controllable()) parts.push_back(fmt::format("{}: {}", axis_label(axis), position_text(axis)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string describe(const v1::Event& event) {
  switch (event.fact_case()) {
    case v1::Event::kMotion:
      return on_one_line(describe_motion(event.motion()));
    case v1::Event::kCompletion:
      return fmt::format("axis {} completed", event.completion().axis());
    case v1::Event::kPathProgress:
      return on_one_line(describe_progress(event.path_progress()));
    case v1::Event::kLink:
      return on_one_line(describe_link(event.link()));
    case v1::Event::kStopRequested:
      return on_one_line(describe_stop(event.stop_requested()));
    case v1::Event::kStop:
      return on_one_line(describe_stop_change(event.stop()));
    case v1::Event::kEmergencyLatch:
      return on_one_line(describe_latch(event.emergency_latch()));
    case v1::Event::kForeignMotion:
      return on_one_line(describe_foreign(event.foreign_motion()));
    case v1::Event::kCondition:
      return on_one_line(describe_condition(event.condition()));
    case v1::Event::kSwitchesChanged:
      return on_one_line(describe_switches(event.switches_changed()));
    case v1::Event::kProgramNotice:
      return on_one_line(describe_notice(event.program_notice()));
    case v1::Event::kDaemonStarted:
      return describe_start(event.daemon_started());
    case v1::Event::kJob:
      return on_one_line(change_text(event.job()));
    case v1::Event::FACT_NOT_SET:
      break;
  }
  return "an event that this axisctl does not know";
}

std::string kind_name(v1::MotionKind kind) {
  std::string name = without_prefix(v1::MotionKind_Name(kind), "MOTION_KIND_", kind);
  std::transform(name.begin(), name.end(), name.begin(), [](char c) { return c == '_' ? '-' : char(std::tolower(c)); });
  return name;
}

std::string state_name(v1::MotionState state) {
  return without_prefix(v1::MotionState_Name(state), "MOTION_STATE_", state);
}

std::string link_name(v1::LinkState state) { return without_prefix(v1::LinkState_Name(state), "LINK_STATE_", state); }

std::string_view last_part(std::string_view resource) { return resource.substr(resource.rfind('/') + 1); }

std::string time_text(const google::protobuf::Timestamp& time) {
  const std::time_t seconds = google::protobuf::util::TimeUtil::TimestampToTimeT(time);
  std::tm local{};
  ::localtime_r(&seconds, &local);
  char text[32];
  std::strftime(text, sizeof text, "%F %T", &local);
  return text + utc_offset(local);
}

std::string utc_offset(const std::tm& local) {
  char text[16];
  std::strftime(text, sizeof text, "%z", &local);
  return std::string(text).insert(3, ":");
}

std::string duration_text(const google::protobuf::Timestamp& from, const google::protobuf::Timestamp& to) {
  return duration_text(to - from);
}

std::string duration_text(const google::protobuf::Duration& duration) {
  using google::protobuf::util::TimeUtil;
  constexpr std::int64_t minute = 60, hour = 60 * minute, day = 24 * hour;
  const std::int64_t ms = std::max<std::int64_t>(0, TimeUtil::DurationToMilliseconds(duration));
  const std::int64_t tenths = (ms + 50) / 100, s = (ms + 500) / 1000;
  if (tenths < 100 && tenths % 10 != 0) return fmt::format("{}.{} s", tenths / 10, tenths % 10);
  if (s < minute) return fmt::format("{} s", s);
  if (s < hour) return fmt::format("{} min {} s", s / minute, s % minute);
  if (s < day) return fmt::format("{} h {} min", s / hour, s % hour / minute);
  return fmt::format("{} d {} h", s / day, s % day / hour);
}

}  // namespace axisgate::axisctl
