// mill jog, origin, spindle, raise: manual operation of a mill, without a job.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill/mill_calls.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "device/core/quantity.h"

namespace axisgate::axisctl {
namespace {

// Adds a typed distance, such as "x=5" or "Z=-0.5mm", to the step. A bare number is in mm.
void add_distance(std::string_view text, v1::JogStep& step) {
  const char axis = text.size() > 2 && text[1] == '=' ? static_cast<char>(std::toupper(text[0])) : '?';
  const Result<Quantity> distance =
      parse_quantity(text.substr(std::min<std::size_t>(2, text.size())), Unit::millimeters);
  if (axis < 'X' || axis > 'Z' || !distance) {
    throw usage(fmt::format("\"{}\" is not an axis and a distance", text),
                "name an axis and how many mm it moves, e.g. x=5 or z=-0.5");
  }
  if (axis == 'X') *step.mutable_x() = to_distance(*distance);
  if (axis == 'Y') *step.mutable_y() = to_distance(*distance);
  if (axis == 'Z') *step.mutable_z() = to_distance(*distance);
}

v1::Speed typed_speed(std::string_view text) {
  const Result<Quantity> speed = parse_speed(text, Unit::millimeters);
  if (!speed) throw to_usage(speed.error());
  return to_speed(*speed);
}

int operate(const Session& session, v1::OperateMillRequest request, std::string_view sent) {
  request.set_device(mill_to_change(session));
  *request.mutable_context() = session.connection.new_call_context();
  const v1::OperateMillResponse response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::OperateMill, request, kQuestionLimit);
  if (session.options.json) {
    print_json(response);
    return kDone;
  }
  const double seconds =
      static_cast<double>(response.longest_time().seconds()) + response.longest_time().nanos() * 1e-9;
  print_line(seconds == 0
                 ? fmt::format("{} was sent", sent)
                 : fmt::format("{} was sent; by its profile the mill has done it within {:.1f} s", sent, seconds));
  return kDone;
}

int mill_jog(const Session& session) {
  v1::OperateMillRequest request;
  for (const std::string& text : session.options.job.distances) add_distance(text, *request.mutable_step());
  const std::string& speed = session.options.job.speed;
  if (!speed.empty()) *request.mutable_step()->mutable_speed() = typed_speed(speed);
  return operate(session, request, "the step, unchecked because the tool's position is not known,");
}

int mill_origin(const Session& session) {
  v1::OperateMillRequest request;
  v1::SetZ0& surface = *request.mutable_surface();
  surface.set_origin(session.options.job.origin);
  if (session.options.job.z) surface.mutable_z()->set_pulses(*session.options.job.z);
  return operate(session, request, "Z0");
}

int mill_spindle(const Session& session) {
  v1::OperateMillRequest request;
  request.set_spindle(session.options.job.spindle == "on");
  return operate(session, request, fmt::format("spindle {}", session.options.job.spindle));
}

int mill_raise(const Session& session) {
  v1::OperateMillRequest request;
  request.mutable_raise_tool();
  return operate(session, request, "spindle off and tool up");
}

void mill_jog_options(CLI::App& verb, Options& options) {
  verb.add_option("AXIS=MM", options.job.distances, "by how much each axis moves, e.g. x=5 z=-0.5; Z upward")
      ->required()
      ->type_name("");
  verb.add_option("--speed", options.job.speed, "in mm/s (default: the mill's)")->type_name("MM/S");
}

void mill_origin_options(CLI::App& verb, Options& options) {
  CLI::Option* name = verb.add_option("NAME", options.job.origin,
                                      "an origin of the configuration that has a height (default: where the tool is)");
  name->type_name("");
  verb.add_option("--z", options.job.z, "a machine coordinate, in steps")->type_name("STEPS")->excludes(name);
}

void mill_spindle_options(CLI::App& verb, Options& options) {
  verb.add_option("on|off", options.job.spindle, "whether it turns")
      ->required()
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("");
}

constexpr Verb kMillHandVerbs[] = {
    {.words = "mill jog",
     .description = "move the tool by a short step, unchecked; the spindle stops before it",
     .add_options = mill_jog_options,
     .run = mill_jog},
    {.words = "mill origin",
     .description = "set Z0; X and Y are set at the mill's panel",
     .add_options = mill_origin_options,
     .run = mill_origin},
    {.words = "mill spindle",
     .description = "start or stop the spindle",
     .add_options = mill_spindle_options,
     .run = mill_spindle},
    {.words = "mill raise", .description = "stop the spindle, and raise the tool to the top", .run = mill_raise},
};

}  // namespace

std::span<const Verb> mill_hand_verbs() { return kMillHandVerbs; }

}  // namespace axisgate::axisctl
