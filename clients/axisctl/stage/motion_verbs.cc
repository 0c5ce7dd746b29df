// home, move and scan: request a motion, then wait for its outcome.
#include <functional>
#include <optional>

#include "clients/axisctl/outcome.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

template <class Request, class Method>
v1::Motion start_on_axes(const Session& session, const v1::Device& device, Method method) {
  Request request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  for (const int axis : find_axes(device, session.options.axes)) request.add_axes(axis);
  return session.connection.call(session.connection.stage, method, request, kStartLimit).motion();
}

v1::AxisTarget target(const Session& session, const v1::Device& device, const std::string& place) {
  const v1::AxisDistance parsed = parse_place(device, place);
  const v1::Axis& axis = find_axis(device, std::to_string(parsed.axis()));
  v1::AxisTarget target;
  target.set_axis(parsed.axis());
  *target.mutable_distance() = parsed.distance();
  if (!session.options.speed.empty()) {
    *target.mutable_profile()->mutable_maximum() = parse_speed_for(axis, session.options.speed);
  }
  if (session.options.acceleration_ms != 0) {
    target.mutable_profile()->set_acceleration_ms(session.options.acceleration_ms);
  }
  if (!session.options.approach.empty()) {
    *target.mutable_approach() = parse_amount_for(axis, session.options.approach);
  }
  return target;
}

}  // namespace

int home(const Session& session) {
  const v1::Device device = chosen_device(session);
  return start_and_wait(session, device, [&] {
    return session.options.logical
               ? start_on_axes<v1::ReturnToOriginRequest>(session, device, &v1::StageService::Stub::ReturnToOrigin)
               : start_on_axes<v1::HomeRequest>(session, device, &v1::StageService::Stub::Home);
  });
}

int move(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::MoveRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  request.set_relative(session.options.relative);
  for (const std::string& place : session.options.places) *request.add_targets() = target(session, device, place);
  return start_and_wait(session, device, [&] {
    return session.connection.call(session.connection.stage, &v1::StageService::Stub::Move, request, kStartLimit)
        .motion();
  });
}

int scan(const Session& session) {
  const Options& options = session.options;
  const v1::Device device = chosen_device(session);
  const v1::Axis& axis = find_axis(device, options.axis);
  v1::ScanRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  request.set_axis(axis.number());
  *request.mutable_from() = parse_amount_for(axis, options.from);
  *request.mutable_to() = parse_amount_for(axis, options.to);
  if (!options.speed.empty()) *request.mutable_speed() = parse_speed_for(axis, options.speed);
  request.set_acceleration_ms(options.acceleration_ms);
  if (options.by_scale) {
    request.set_scale_pulses(options.every);
  } else {
    request.set_drive_pulses(options.every);
  }
  return start_and_wait(session, device, [&] {
    return session.connection.call(session.connection.stage, &v1::StageService::Stub::Scan, request, kStartLimit)
        .motion();
  });
}

}  // namespace axisgate::axisctl
