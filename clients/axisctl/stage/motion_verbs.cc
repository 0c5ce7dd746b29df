// home and move: request a motion, then wait for its outcome.
#include <CLI/CLI.hpp>
#include <functional>
#include <optional>

#include "clients/axisctl/arguments/verb_options.h"
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
  for (const int axis : find_axes(device, session.options.axes)) request.add_axes(std::to_string(axis));
  return session.connection.call(session.connection.stage, method, request, kStartLimit).motion();
}

v1::AxisTarget target(const Session& session, const v1::Device& device, const std::string& place) {
  const v1::AxisDistance parsed = parse_place(device, place);
  const v1::Axis& axis = find_axis(device, parsed.axis());
  v1::AxisTarget target;
  target.set_axis(parsed.axis());
  *target.mutable_distance() = parsed.distance();
  if (!session.options.speed.empty()) {
    *target.mutable_profile()->mutable_maximum() = parse_speed_for(axis, session.options.speed);
  }
  if (session.options.acceleration_ms != 0) {
    *target.mutable_profile()->mutable_acceleration_time() = from_milliseconds(session.options.acceleration_ms);
  }
  if (!session.options.approach.empty()) {
    *target.mutable_approach() = parse_amount_for(axis, session.options.approach);
  }
  return target;
}

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

void home_options(CLI::App& verb, Options& options) {
  add_axes(verb, options);
  verb.add_flag("--logical", options.logical, "move to the logical origin instead: coordinate 0");
  add_waiting(verb, options);
}

void move_options(CLI::App& verb, Options& options) {
  verb.add_option("AXIS=AMOUNT", options.places, "where each axis moves, e.g. 1=5mm 2=-0.2mm")
      ->required()
      ->type_name("");
  verb.add_flag("--relative", options.relative, "the amounts are distances from the present positions");
  verb.add_option(
          "--approach", options.approach,
          "reach the target over this last distance in + direction, e.g. 10um; in - direction: --approach=-10um")
      ->type_name("AMOUNT");
  add_speed(verb, options, "maximum speed of each axis, e.g. 2mm/s (default: see `axisctl speed`)");
  add_waiting(verb, options);
}

constexpr Verb kMotionVerbs[] = {
    {.words = "home",
     .heading = Heading::moving,
     .description = "home axes: find the mechanical origin, which becomes coordinate 0",
     .help =
         R"(Each axis runs to its origin sensor. Its coordinate becomes 0 there, and the travel limits count from there. Ctrl-C ends
axisctl, not the motion: `axisctl stop` stops it.)",
     .examples = "axisctl home 1 2",
     .add_options = home_options,
     .run = home,
     .waits = true},
    {.words = "move",
     .heading = Heading::moving,
     .description = "move axes to positions, or with --relative by distances",
     .help =
         R"(Amounts are absolute positions. With --relative they are distances from the present positions. A + sign alone does not
make a move relative. `axisctl help units` explains amounts.

All axes start together, each at its own speed: two axes do not follow a straight line. `axisctl line` does. With
--approach each axis makes the last part of its move in the same direction every time, so backlash has no effect. Ctrl-C
ends axisctl, not the motion: `axisctl stop` stops it.)",
     .examples = R"(axisctl move 1=+1mm 2=-200um --relative --speed 2mm/s
axisctl move 1=0.5mm --wait 60
axisctl move 1=0.4mm 2=0 --approach 10um)",
     .add_options = move_options,
     .run = move,
     .waits = true},
};

}  // namespace

std::span<const Verb> motion_verbs() { return kMotionVerbs; }

}  // namespace axisgate::axisctl
