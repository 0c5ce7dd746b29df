#include "clients/axisctl/motion_follower.h"

#include <google/protobuf/util/time_util.h>

#include <chrono>
#include <utility>

#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

bool concerns(const v1::Event& event, const std::string& motion) {
  switch (event.fact_case()) {
    case v1::Event::kMotion:
      return event.motion().name() == motion;
    case v1::Event::kCompletion:
      return event.completion().motion() == motion;
    case v1::Event::kPathProgress:
      return event.path_progress().motion() == motion;
    default:
      return true;  // other events, such as stops and changes of the line, concern every motion of the device
  }
}

bool is_last(const v1::Event& event, const std::string& motion) {
  return event.has_motion() && event.motion().name() == motion && event.motion().state() >= v1::MOTION_STATE_SUCCEEDED;
}

}  // namespace

MotionFollower::MotionFollower(const Session& session, const v1::Device& device)
    : session_(session), device_(device.name()) {
  v1::WatchRequest request;
  request.set_device(device.name());
  events_ = session.connection.events->Watch(&events_context_, request);
  // The headers show that the subscription has begun: later events are delivered.
  events_->WaitForInitialMetadata();
}

MotionFollower::~MotionFollower() {
  events_context_.TryCancel();
  positions_context_.TryCancel();
  if (events_thread_.joinable()) events_thread_.join();
  if (positions_thread_.joinable()) positions_thread_.join();
  events_->Finish();
}

void MotionFollower::follow(const std::string& motion) {
  std::promise<void> all_shown;
  all_shown_ = all_shown.get_future();
  events_thread_ = std::thread(&MotionFollower::show_events, this, motion, std::move(all_shown));
  if (!session_.options.json) positions_thread_ = std::thread(&MotionFollower::show_positions, this);
}

void MotionFollower::finish() {
  all_shown_.wait_for(std::chrono::seconds(1));
  positions_context_.TryCancel();
  if (positions_thread_.joinable()) positions_thread_.join();
  display_.finish();
}

void MotionFollower::show_events(const std::string& motion, std::promise<void> all_shown) {
  v1::WatchResponse response;
  while (events_->Read(&response)) {
    const v1::Event& event = response.event();
    if (!concerns(event, motion)) continue;
    if (session_.options.json) {
      print_json(event);
    } else if (!is_last(event, motion)) {  // the verb itself reports the outcome
      display_.fact(describe(event));
    }
    if (is_last(event, motion)) break;
  }
  all_shown.set_value();
}

void MotionFollower::show_positions() {
  v1::WatchDeviceRequest request;
  request.set_device(device_);
  *request.mutable_min_interval() =
      google::protobuf::util::TimeUtil::MillisecondsToDuration(display_.interval().count());
  const auto reader = session_.connection.devices->WatchDevice(&positions_context_, request);
  v1::WatchDeviceResponse response;
  while (reader->Read(&response)) display_.in_place(positions_text(response.device()));
  reader->Finish();
}

}  // namespace axisgate::axisctl
