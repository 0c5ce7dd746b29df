#include "clients/axisctl/stage/setting_calls.h"

#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {

v1::Settings settings_of(const Session& session, const v1::Device& device) {
  v1::GetSettingsRequest request;
  request.set_device(device.name());
  return session.connection
      .call(session.connection.settings, &v1::SettingService::Stub::GetSettings, request, kSettingLimit)
      .settings();
}

int change_settings(const Session& session, const v1::Device& device, const v1::Settings& wanted) {
  v1::ChangeSettingsRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  *request.mutable_settings() = wanted;
  return report_done(
      session, session.connection.call(session.connection.settings, &v1::SettingService::Stub::ChangeSettings, request,
                                       kSettingLimit));
}

int report_done(const Session& session, const google::protobuf::Message& response) {
  session.options.json ? print_json(response) : print_line("OK");
  return kDone;
}

std::vector<int> chosen_axes(const Session& session, const v1::Device& device) {
  if (!session.options.axes.empty()) return find_axes(device, session.options.axes);
  std::vector<int> axes;
  for (const v1::Axis& axis : device.axes()) {
    if (axis.controllable()) axes.push_back(axis.number());
  }
  return axes;
}

}  // namespace axisgate::axisctl
