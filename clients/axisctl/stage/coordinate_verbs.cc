// zero, unzero and preset: set the coordinates of an axis's present position.
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

}  // namespace

int set_origin(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::SetCoordinatesRequest request;
  for (const int axis : chosen_axes(session, device)) {
    v1::AxisCoordinate& coordinate = *request.add_coordinates();
    coordinate.set_axis(axis);
    coordinate.set_set_origin(true);
  }
  return set_coordinates(session, request, device);
}

int unset_origin(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::SetCoordinatesRequest request;
  for (const int axis : chosen_axes(session, device)) {
    v1::AxisCoordinate& coordinate = *request.add_coordinates();
    coordinate.set_axis(axis);
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

}  // namespace axisgate::axisctl
