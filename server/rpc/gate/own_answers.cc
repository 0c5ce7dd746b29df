#include "server/rpc/gate/own_answers.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>
#include <vector>

#include "device/link/clock.h"
#include "server/proto/amounts.h"
#include "server/proto/digest.h"
#include "server/proto/mills.h"
#include "server/proto/to_proto.h"
#include "server/proto/transactions.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unreadable.h"

namespace axisgate::rpc {
namespace {

using api::RequestKind;
using front::Answer;

template <class Response>
Response reports_in(const std::vector<api::DeviceStop>& stops) {
  Response response;
  for (const api::DeviceStop& one : stops) *response.add_devices() = proto::to_proto(one);
  response.set_stays_open(std::ranges::any_of(stops, [](const auto& one) { return one.report.stays_open; }));
  if (response.devices_size() != 1) return response;
  const v1::DeviceStop& only = response.devices(0);
  *response.mutable_axes() = only.axes();
  if (only.has_problem()) *response.mutable_problem() = only.problem();
  return response;
}

// Builds the Call of a stop. Its deadline is at the latest the end of max_wait.
template <class Request>
api::Call call_of_stop(const Served& served, std::optional<TimePoint> deadline, const Request& request) {
  api::Call call = to_call(served.credential(), deadline, request.context());
  if (request.has_max_wait()) {
    const TimePoint end = monotonic_now() + std::max(Duration::zero(), proto::to_duration(request.max_wait()));
    call.deadline = std::min(end, call.deadline.value_or(end));
  }
  return call;
}

v1::ListDevicesResponse list_of(const api::DeviceList& list) {
  v1::ListDevicesResponse response;
  for (const auto& one : list.devices) {
    const auto* stage = std::get_if<api::DeviceState>(&one);
    *response.add_devices() = stage == nullptr ? proto::device_of(std::get<api::MillState>(one))
                                               : proto::to_proto(*stage->device, *stage->state);
  }
  response.set_request_memory(list.request_memory);
  response.set_requests_kept(list.requests_kept);
  response.set_version(list.version);
  *response.mutable_time() = proto::to_proto(server::WallTime(std::chrono::system_clock::now()));
  response.set_next_revision(list.next_revision);
  response.set_run(list.run);
  return response;
}

}  // namespace

template <class Request, OwnAnswers::Method<Request> kMethod>
std::unique_ptr<Answer> OwnAnswers::parsed(std::optional<std::string_view> message, Asked asked) const {
  Request request;
  if (message && request.ParseFromArray(message->data(), static_cast<int>(message->size())))
    return (this->*kMethod)(request, std::move(asked));
  const std::string method = asked.served->method();
  front::Reply refusal = asked.served->refused(message ? not_readable(method) : not_one_message(method));
  return answer_now(std::move(refusal), std::move(asked.wake));
}

const OwnAnswers::Row* OwnAnswers::row_of(RequestKind kind) {
  static constexpr std::array kRows = {
      Row{RequestKind::stop, &OwnAnswers::parsed<v1::StopRequest, &OwnAnswers::stop>},
      Row{RequestKind::emergency_stop, &OwnAnswers::parsed<v1::EmergencyStopRequest, &OwnAnswers::emergency_stop>},
      Row{RequestKind::abort_job, &OwnAnswers::parsed<v1::AbortJobRequest, &OwnAnswers::abort_job>},
      Row{RequestKind::list_devices, &OwnAnswers::parsed<v1::ListDevicesRequest, &OwnAnswers::list_devices>},
      Row{RequestKind::get_device, &OwnAnswers::parsed<v1::GetDeviceRequest, &OwnAnswers::get_device>},
      Row{RequestKind::execute, &OwnAnswers::parsed<v1::ExecuteRequest, &OwnAnswers::execute>},
  };
  const auto found = std::ranges::find(kRows, kind, &Row::kind);
  return found == kRows.end() ? nullptr : &*found;
}

std::unique_ptr<Answer> OwnAnswers::answer(const Row& row, std::shared_ptr<Served> served,
                                           std::optional<TimePoint> deadline, std::optional<std::string_view> message,
                                           Wake wake) const {
  return (this->*row.answer)(message, {std::move(served), deadline, std::move(wake)});
}

std::unique_ptr<Answer> OwnAnswers::stop(const v1::StopRequest& request, Asked asked) const {
  const api::Call call = call_of_stop(*asked.served, asked.deadline, request);
  return one_answer<std::vector<api::DeviceStop>>(
      asked.served, asked.wake, reports_in<v1::StopResponse>, [&](api::Answer<std::vector<api::DeviceStop>> answer) {
        api_.stops.stop(call, request.device(),
                        proto::to_axes(request.axes(), api::axis_names(gateway_, request.device())), std::move(answer));
      });
}

std::unique_ptr<Answer> OwnAnswers::emergency_stop(const v1::EmergencyStopRequest& request, Asked asked) const {
  const api::Call call = call_of_stop(*asked.served, asked.deadline, request);
  return one_answer<std::vector<api::DeviceStop>>(asked.served, asked.wake, reports_in<v1::EmergencyStopResponse>,
                                                  [&](api::Answer<std::vector<api::DeviceStop>> answer) {
                                                    api_.stops.emergency_stop(call, request.device(),
                                                                              std::move(answer));
                                                  });
}

std::unique_ptr<Answer> OwnAnswers::abort_job(const v1::AbortJobRequest& request, Asked asked) const {
  const auto fill = [](const api::CurrentRun& run) {
    v1::AbortJobResponse response;
    if (run.running) *response.mutable_running() = proto::to_proto(run);
    if (run.executed) *response.mutable_executed() = proto::to_proto(*run.executed);
    return response;
  };
  const api::Call call = to_call(asked.served->credential(), asked.deadline, request.context());
  return one_answer<api::CurrentRun>(asked.served, asked.wake, fill, [&](api::Answer<api::CurrentRun> answer) {
    api_.mill.mills.abort(call, request.device(), std::move(answer));
  });
}

std::unique_ptr<Answer> OwnAnswers::list_devices(const v1::ListDevicesRequest&, Asked asked) const {
  return one_answer<api::DeviceList>(asked.served, asked.wake, list_of,
                                     [&](const api::Answer<api::DeviceList>& answer) {
                                       answer(api_.devices.list({.credential = asked.served->credential()}));
                                     });
}

std::unique_ptr<Answer> OwnAnswers::get_device(const v1::GetDeviceRequest& request, Asked asked) const {
  const auto fill = [](const api::DeviceNow& now) {
    v1::GetDeviceResponse response;
    const auto* stage = std::get_if<api::StageNow>(&now);
    *response.mutable_device() = stage == nullptr ? proto::device_of(std::get<api::MillState>(now))
                                                  : proto::to_proto(*stage->device, *stage->state);
    return response;
  };
  const auto max_age = request.has_max_age() ? std::optional(proto::to_span(request.max_age())) : std::nullopt;
  return one_answer<api::DeviceNow>(asked.served, asked.wake, fill, [&](api::Answer<api::DeviceNow> answer) {
    api_.devices.get({.credential = asked.served->credential(), .deadline = asked.deadline}, request.device(), max_age,
                     std::move(answer));
  });
}

std::unique_ptr<Answer> OwnAnswers::execute(const v1::ExecuteRequest& request, Asked asked) const {
  api::Call call = to_call(asked.served->credential(), asked.deadline, request.context());
  call.validate_only = request.validate_only();
  if (!call.request_id.empty()) call.digest = proto::digest_of(request);
  const auto opened = api_.commands.execute(call, request.device(), proto::to_transaction(request));
  const auto fill = [device = request.device()](const stage::ExecuteEvent& event) {
    return proto::to_response(device, event);
  };
  return stream_answer(opened, std::move(asked.served), fill, std::move(asked.wake));
}

}  // namespace axisgate::rpc
