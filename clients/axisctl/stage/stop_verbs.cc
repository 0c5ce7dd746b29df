// stop and estop: one call, also for several devices. The texts never claim more about an axis than is known.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "clients/axisctl/arguments/verb_options.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "device/stage/axes.h"

namespace axisgate::axisctl {
namespace {

std::string describe_reply(const v1::AxisStop& stop, bool stays_open) {
  if (!stop.named()) return stays_open ? "no stop sent yet" : "no stop sent, its motor is off";
  if (stop.reply_unreadable()) return "unreadable reply to the stop";
  return stop.wire_reply().empty() ? "no reply to the stop" : "replied " + stop.wire_reply();
}

std::string describe_position(const v1::AxisStop& stop) {
  if (!stop.has_position_pulses()) return ", position unknown";
  if (stop.position().empty()) return fmt::format(" at {} pulse", stop.position_pulses());
  return fmt::format(" at {} {}", stop.position(), symbol(core_unit(stop.unit())));
}

std::string describe_stop(const v1::AxisStop& stop, bool stays_open) {
  const char* state = !stop.has_ready() ? "state unknown" : stop.ready() ? "stationary" : "STILL MOVING";
  return fmt::format("axis {}: {}, {}{}", stop.name().empty() ? std::to_string(stop.axis()) : stop.name(),
                     describe_reply(stop, stays_open), state, describe_position(stop));
}

// Returns the error; nullopt if all axes are stationary. A stop that stays open has failed, whatever the reason.
std::optional<Failure> failure_of(const v1::DeviceStop& device) {
  if (device.has_problem()) {
    Failure failure = to_failure(device.problem());
    if (device.stays_open()) failure.exit_code = kFailed;
    return failure;
  }
  for (const v1::AxisStop& stop : device.axes()) {
    if (!stop.has_ready() || !stop.ready()) {
      return Failure{kFailed, "OUTCOME_UNKNOWN", fmt::format("axis {} was not confirmed stationary", stop.axis()),
                     "check the stage"};
    }
  }
  return std::nullopt;
}

// Prints the lines and the error of every device, independent of the other devices. Returns the exit code of the first
// error.
template <class Response>
int report(const Session& session, const Response& response) {
  if (session.options.json) print_json(response);
  int exit_code = kDone;
  for (const v1::DeviceStop& device : response.devices()) {
    const std::string whose = response.devices_size() > 1 ? fmt::format("{}: ", last_part(device.device())) : "";
    if (!session.options.json) {
      for (const v1::AxisStop& stop : device.axes()) print_line(whose + describe_stop(stop, device.stays_open()));
    }
    auto failure = failure_of(device);
    if (device.stays_open() && !session.options.json) {
      print_line(fmt::format("{}stop {} stays open and is repeated until the axes are seen stationary: axisctl status",
                             whose, last_part(device.stop())));
    }
    if (!failure && device.stays_open()) exit_code = kFailed;
    if (!failure) continue;
    failure->message = whose + failure->message;
    print_failure(*failure);
    if (exit_code == kDone) exit_code = failure->exit_code;
  }
  return exit_code;
}

// Returns the number of an axis that a stage may have; nullopt for any other text, such as a name.
std::optional<int> axis_number(std::string_view text) {
  if (text.size() != 1 || text[0] < '1' || text[0] > '0' + stage::kAxesMax) return std::nullopt;
  return text[0] - '0';
}

// Sets the axes to stop. Asks the daemon first only if axes were given by name.
void set_axes(const Session& session, v1::StopRequest& request) {
  const std::vector<std::string>& axes = session.options.axes;
  if (std::ranges::all_of(axes, [](const std::string& axis) { return axis_number(axis).has_value(); })) {
    for (const std::string& axis : axes) request.add_axes(std::to_string(*axis_number(axis)));
    return;
  }
  const v1::Device device = chosen_device(session);
  request.set_device(device.name());
  for (const int axis : find_axes(device, axes)) request.add_axes(std::to_string(axis));
}

template <class Request>
Request new_request(const Session& session) {
  Request request;
  *request.mutable_context() = new_stop_context();
  request.set_device(session.options.device);
  request.mutable_max_wait()->set_seconds(kStopWait.count());
  return request;
}

int stop(const Session& session) {
  auto request = new_request<v1::StopRequest>(session);
  set_axes(session, request);
  try {
    return report(
        session, session.connection.call(session.connection.stage, &v1::StageService::Stub::Stop, request, kStopLimit));
  } catch (const Failure& failure) {
    // With several devices, axes need --device: chosen_device() throws the same Failure as for other commands.
    if (failure.reason == "INVALID_REQUEST" && request.device().empty()) (void)chosen_device(session);
    throw;
  }
}

int emergency_stop(const Session& session) {
  const auto request = new_request<v1::EmergencyStopRequest>(session);
  const int exit_code = report(
      session,
      session.connection.call(session.connection.stage, &v1::StageService::Stub::EmergencyStop, request, kStopLimit));
  if (!session.options.json) print_line("nothing moves until `axisctl clear`; the motors may be off then");
  return exit_code;
}

constexpr Verb kStopVerbs[] = {
    {.words = "stop",
     .heading = Heading::stopping,
     .description = "slow down and stop axes, also those that others move",
     .help =
         R"(Anybody may stop all axes, also those that others move. After a stop by somebody else, motions are refused until their
caller types `axisctl rearm`. With `estop` the axes do not slow down first, and nothing moves until `axisctl clear`.
If nobody could see the axes obey, the exit code is 1 and the stop stays open: the daemon repeats it as soon as the
controller answers, also after a restart, and refuses motion of these axes until then. `axisctl status` shows it.)",
     .examples = "axisctl stop",
     .add_options = add_axes,
     .run = stop},
    {.words = "estop",
     .heading = Heading::stopping,
     .description = "emergency stop: stop all axes at once; no motion until `clear`",
     .help = "Not a safety function: keep the wired emergency stop within reach.",
     .examples = "axisctl estop",
     .run = emergency_stop},
};

}  // namespace

std::span<const Verb> stop_verbs() { return kStopVerbs; }

}  // namespace axisgate::axisctl
