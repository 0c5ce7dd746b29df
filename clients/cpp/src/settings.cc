// Settings of a Stage.
#include <google/protobuf/util/time_util.h>

#include "axisgate/stage.h"
#include "clients/cpp/src/amounts.h"
#include "clients/cpp/src/session.h"

namespace axisgate {
namespace {

// Time for which a change of settings may wait for running commands.
constexpr std::chrono::seconds kChangeTime{20};

void change_axis(client::DeviceSession& session, const v1::AxisSettings& axis) {
  v1::ChangeSettingsRequest request;
  request.set_device(session.device());
  *request.mutable_settings()->add_axes() = axis;
  session.act(session.services().settings, &v1::SettingService::Stub::ChangeSettings, request, kChangeTime);
}

}  // namespace

void Stage::switch_motor(std::string_view axis, bool on) const {
  v1::AxisSettings settings;
  settings.set_axis(std::string(axis));
  settings.set_excited(on);
  change_axis(*session_, settings);
}

void Stage::set_speeds(std::string_view axis, const SpeedTerms& speeds) const {
  v1::AxisSettings settings;
  settings.set_axis(std::string(axis));
  v1::Profile& profile = *settings.mutable_speeds();
  if (speeds.minimum) *profile.mutable_minimum() = client::to_message(*speeds.minimum);
  if (speeds.maximum) *profile.mutable_maximum() = client::to_message(*speeds.maximum);
  if (speeds.acceleration) {
    *profile.mutable_acceleration_time() =
        google::protobuf::util::TimeUtil::MillisecondsToDuration(speeds.acceleration->count());
  }
  change_axis(*session_, settings);
}

}  // namespace axisgate
