// zero, unzero and preset: set the coordinates of an axis's present position.
#include <CLI/CLI.hpp>

#include "clients/axisctl/arguments/verb_options.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/stage/setting_calls.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

int set_coordinates(const Session& session, v1::SetCoordinatesRequest request, const v1::Device& device) {
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  return report_done(
      session, session.connection.call(session.connection.settings, &v1::SettingService::Stub::SetCoordinates, request,
                                       kSettingLimit));
}

int set_origin(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::SetCoordinatesRequest request;
  for (const int axis : chosen_axes(session, device)) {
    v1::AxisCoordinate& coordinate = *request.add_coordinates();
    coordinate.set_axis(std::to_string(axis));
    coordinate.set_set_origin(true);
  }
  return set_coordinates(session, request, device);
}

int unset_origin(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::SetCoordinatesRequest request;
  for (const int axis : chosen_axes(session, device)) {
    v1::AxisCoordinate& coordinate = *request.add_coordinates();
    coordinate.set_axis(std::to_string(axis));
    coordinate.set_unset_origin(true);
  }
  return set_coordinates(session, request, device);
}

int preset_coordinates(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::SetCoordinatesRequest request;
  for (const std::string& place : session.options.places) {
    const v1::AxisDistance parsed = parse_place(device, place);
    v1::AxisCoordinate& coordinate = *request.add_coordinates();
    coordinate.set_axis(parsed.axis());
    *coordinate.mutable_position() = parsed.distance();
  }
  return set_coordinates(session, request, device);
}

void preset_options(CLI::App& verb, Options& options) {
  verb.add_option("AXIS=AMOUNT", options.places, "the new coordinate of each axis, e.g. 1=5mm")
      ->required()
      ->type_name("");
}

constexpr Verb kCoordinateVerbs[] = {
    {.words = "zero",
     .heading = Heading::settings,
     .description = "set the coordinates of axes to 0, without motion",
     .help = "Nothing moves: the present position gets the coordinate 0.",
     .examples = "axisctl zero 1",
     .add_options = add_axes,
     .run = set_origin,
     .waits = true},
    {.words = "unzero",
     .heading = Heading::settings,
     .description = "undo `zero`",
     .help = "Undoes `zero`.",
     .examples = "axisctl unzero 1",
     .add_options = add_axes,
     .run = unset_origin,
     .waits = true},
    {.words = "preset",
     .heading = Heading::settings,
     .description = "set the coordinates of axes, without motion",
     .help = "Nothing moves: the present position gets this coordinate. Travel limits are relative to the origin of "
             "`home`.",
     .examples = "axisctl preset 1=0.5mm 2=-20um",
     .add_options = preset_options,
     .run = preset_coordinates,
     .waits = true},
};

}  // namespace

std::span<const Verb> coordinate_verbs() { return kCoordinateVerbs; }

}  // namespace axisgate::axisctl
