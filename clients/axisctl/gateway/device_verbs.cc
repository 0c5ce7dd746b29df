// devices, status, position: show the devices and their state.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <google/protobuf/util/time_util.h>

#include <optional>

#include "clients/axisctl/condition_text.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

v1::Device read_now(const Session& session, const std::string& name) {
  v1::GetDeviceRequest request;
  request.set_device(name);
  request.mutable_max_age();
  return session.connection
      .call(session.connection.devices, &v1::DeviceService::Stub::GetDevice, request, kQuestionLimit)
      .device();
}

std::string link_text(const v1::Device& device) {
  return device.link_problem().empty() ? link_name(device.link())
                                       : fmt::format("{}: {}", link_name(device.link()), device.link_problem());
}

// Returns yes or no, or ? if unknown.
std::string_view known(bool is_known, bool value) { return !is_known ? "?" : value ? "yes" : "no"; }

// Returns S, F and R as parameters of D: (manual 89)), in pulses/s and ms; ? if unknown.
std::string speed_parameters(const v1::Axis& axis) {
  const v1::Profile& speeds = axis.speeds();
  if (!speeds.has_minimum() || !speeds.has_maximum() || !speeds.has_acceleration_time()) return "?";
  return fmt::format("S{}F{}R{}", speeds.minimum().pulses_per_s(), speeds.maximum().pulses_per_s(),
                     milliseconds(speeds.acceleration_time()));
}

std::string axis_text(const v1::Axis& axis) {
  const std::string name = axis.name().empty() ? "" : axis.name() + "  ";
  if (!axis.controllable()) return fmt::format("axis {}  {}not controllable", axis.number(), name);
  return fmt::format("axis {}  {}{}  busy {}  excited {}  homed {}  status {}  speed {}{}", axis.number(), name,
                     position_text(axis), known(axis.has_busy(), axis.busy()),
                     known(axis.has_excited(), axis.excited()), known(true, axis.homed()), status_text(axis),
                     speed_parameters(axis), axis.stage().empty() ? "" : "  stage " + axis.stage());
}

std::string ago(const google::protobuf::Timestamp& time) {
  return duration_text(time, google::protobuf::util::TimeUtil::GetCurrentTime()) + " ago";
}

void print_stops(const v1::Device& device) {
  if (device.has_emergency_latch()) {
    print_line(fmt::format("EMERGENCY STOP by {} {}: nothing moves until `axisctl clear`",
                           device.emergency_latch().caller().name(), ago(device.emergency_latch().request_time())));
  }
  for (const v1::OpenStop& stop : device.open_stops()) {
    const char* state = stop.stale_setpoint()
                            ? "the axes are stationary, but a stale setpoint is left; reset the controller"
                            : "nobody has seen the axes obey it; it is repeated";
    print_line(fmt::format("OPEN STOP {} of {} {} by {} {}: {}", last_part(stop.name()),
                           stop.axes_size() == 1 ? "axis" : "axes", fmt::join(stop.axes(), ", "),
                           names_text(stop.callers()), ago(stop.request_time()), state));
  }
}

void print_status(const v1::Device& device) {
  print_line(fmt::format("{}  {}", last_part(device.name()), link_text(device)));
  print_stops(device);
  if (is_mill(device)) return print_line(fmt::format("{}; `axisctl mill queue` shows its jobs", device.model()));
  if (device.device_epoch() == 0) {
    print_line("controller unknown: it has not replied since the daemon started");
    return;
  }
  print_line(fmt::format("controller  {} {} {}  serial number {}  mode {}  format {}  epoch {}", device.vendor(),
                         device.model(), device.firmware(), device.serial_number(), mode_text(device.mode()),
                         format_text(device.format()), device.device_epoch()));
  for (const v1::Axis& axis : device.axes()) print_line(axis_text(axis));
  print_line(fmt::format("outputs {}  trigger {}", device.has_outputs() ? pins_text(device.outputs(), "OUT") : "?",
                         device.has_trigger() ? trigger_text(device.trigger()) : "?"));
  for (const v1::Axis& axis : device.axes()) {
    if (!axis.stage_problem().empty()) print_line(fmt::format("WRONG STAGE: {}", axis.stage_problem()));
    if (axis.armed()) print_line(fmt::format("ARMED: an input can start axis {}", axis.number()));
    if (axis.foreign_motion())
      print_line(fmt::format("FOREIGN MOTION: axis {} moves without a request to the gateway", axis.number()));
  }
  if (device.moving_unknown()) print_line("MOVING UNKNOWN: the line was lost while an axis moved");
  if (!device.has_age()) print_line("never read");
}

int devices(const Session& session) {
  const v1::ListDevicesResponse answer = session.connection.call(
      session.connection.devices, &v1::DeviceService::Stub::ListDevices, v1::ListDevicesRequest(), kQuestionLimit);
  for (const v1::Device& device : answer.devices()) {
    if (session.options.json) {
      print_json(device);
    } else {
      print_line(fmt::format("{}  {}  {}", last_part(device.name()), device.kind(), link_text(device)));
    }
  }
  return kDone;
}

int status(const Session& session) {
  v1::Device device = any_device(session);
  std::optional<Failure> failure;
  try {
    device = read_now(session, device.name());
  } catch (const Failure& unreadable) {
    failure = unreadable;  // the last known state is still shown
  }
  if (session.options.json) {
    print_json(device);
  } else {
    print_status(device);
  }
  if (failure) throw *failure;
  return kDone;
}

int position(const Session& session) {
  const v1::Device device = read_now(session, chosen_device(session).name());
  for (const v1::Axis& axis : device.axes()) {
    if (!axis.controllable()) continue;
    if (session.options.json) {
      print_json(axis);
    } else {
      print_line(fmt::format("{}  {}", axis_label(axis), position_text(axis)));
    }
  }
  return kDone;
}

constexpr Verb kDeviceVerbs[] = {
    {.words = "devices",
     .heading = Heading::looking,
     .description = "show the configured devices",
     .examples = "axisctl devices",
     .run = devices},
    {.words = "status",
     .heading = Heading::looking,
     .description = "show the serial connection, the controller and the axes",
     .help = "In the output, `?` means that the value is not known, e.g. because it was not read yet.",
     .examples = "axisctl status\naxisctl --json status",
     .run = status},
    {.words = "position",
     .heading = Heading::looking,
     .description = "read and show the present positions of the axes",
     .examples = "axisctl position",
     .run = position},
};

}  // namespace

std::span<const Verb> device_verbs() { return kDeviceVerbs; }

}  // namespace axisgate::axisctl
