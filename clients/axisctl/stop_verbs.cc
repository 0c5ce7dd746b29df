// stop and estop: say of every axis what is known, never more.
#include <fmt/format.h>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

std::string describe_stop(const v1::Device& device, const v1::AxisStop& stop) {
  const v1::Axis& axis = find_axis(device, std::to_string(stop.axis()));
  std::string text = axis_label(axis) + ": ";
  if (!stop.named()) {
    text += "no stop sent, its motor is off";
  } else if (stop.wire_reply().empty()) {
    text += "no reply to the stop";
  } else {
    text += "replied " + stop.wire_reply();
  }
  text += !stop.has_ready() ? ", state unknown" : stop.ready() ? ", stationary" : ", STILL MOVING";
  if (stop.has_position_pulses()) text += " at " + position_text(axis, stop.position_pulses());
  return text;
}

template <class Response>
int report(const Session& session, const v1::Device& device, const Response& response) {
  if (session.options.json) {
    print_json(response);
  } else {
    for (const v1::AxisStop& stop : response.axes()) print_line(describe_stop(device, stop));
  }
  if (response.has_problem()) throw to_failure(response.problem());
  for (const v1::AxisStop& stop : response.axes()) {
    if (!stop.has_ready() || !stop.ready()) {
      throw Failure{kFailed, "OUTCOME_UNKNOWN", fmt::format("axis {} was not confirmed stationary", stop.axis()),
                    "check the stage"};
    }
  }
  return kDone;
}

}  // namespace

int stop(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::StopRequest request;
  *request.mutable_context() = new_stop_context();
  request.set_device(device.name());
  for (const int axis : find_axes(device, session.options.axes)) request.add_axes(axis);
  return report(session, device,
                session.connection.call(session.connection.stage, &v1::StageService::Stub::Stop, request, kStopLimit));
}

int emergency_stop(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::EmergencyStopRequest request;
  *request.mutable_context() = new_stop_context();
  request.set_device(device.name());
  const v1::EmergencyStopResponse response =
      session.connection.call(session.connection.stage, &v1::StageService::Stub::EmergencyStop, request, kStopLimit);
  const int exit_code = report(session, device, response);
  if (!session.options.json)
    print_line("emergency stop: nothing moves until `axisctl clear`; the motors may be off then");
  return exit_code;
}

}  // namespace axisgate::axisctl
