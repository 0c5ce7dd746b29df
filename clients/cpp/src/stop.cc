// Stops of a Stage.
#include <google/protobuf/util/time_util.h>

#include "axisgate/stage.h"
#include "clients/cpp/src/outcomes.h"
#include "clients/cpp/src/session.h"

namespace axisgate {
namespace {

// Longest time until the answer to a stop, which then has what is known.
constexpr std::chrono::milliseconds kStopTime{4000};

template <class Request>
Request stop_request(const client::DeviceSession& session) {
  Request request;
  request.set_device(session.device());
  request.mutable_context()->set_lease_token(session.token());
  *request.mutable_max_wait() = google::protobuf::util::TimeUtil::MillisecondsToDuration(kStopTime.count());
  return request;
}

}  // namespace

StopReport Stage::stop(const std::vector<std::string>& axes) const {
  auto request = stop_request<v1::StopRequest>(*session_);
  for (const std::string& axis : axes) request.add_axes(axis);
  const auto answer = session_->connection().stop(&v1::StageService::Stub::Stop, request);
  return client::report_of(answer.devices(), answer.stays_open());
}

StopReport Stage::emergency_stop() const {
  const auto answer = session_->connection().stop(&v1::StageService::Stub::EmergencyStop,
                                                  stop_request<v1::EmergencyStopRequest>(*session_));
  return client::report_of(answer.devices(), answer.stays_open());
}

}  // namespace axisgate
