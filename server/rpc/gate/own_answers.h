// The methods that the front answers itself: stops, which share no thread with gRPC, and frequent questions, for which
// each additional thread would cost too much.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "axisgate/v1/command.pb.h"
#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/mill.pb.h"
#include "axisgate/v1/stage.pb.h"
#include "device/core/time.h"
#include "server/api/api.h"
#include "server/front/call_filter.h"
#include "server/rpc/calls/answers.h"
#include "server/rpc/calls/served.h"

namespace axisgate::rpc {

// Thread safe.
class OwnAnswers {
 public:
  // The referenced objects must outlive this one.
  OwnAnswers(const server::Gateway& gateway, const api::Api& api) : gateway_(gateway), api_(api) {}

  // One request: its record, its deadline, and the function to call when the answer is there.
  struct Asked {
    std::shared_ptr<Served> served;
    std::optional<TimePoint> deadline;
    Wake wake;
  };
  // One kind of request that the front answers, and its function.
  struct Row {
    api::RequestKind kind;
    std::unique_ptr<front::Answer> (OwnAnswers::*answer)(std::optional<std::string_view> message, Asked asked) const;
  };
  // Null if gRPC answers this kind.
  static const Row* row_of(api::RequestKind kind);

  // `deadline` is the call's. front::CallFilter::answer() describes `message`.
  std::unique_ptr<front::Answer> answer(const Row& row, std::shared_ptr<Served> served,
                                        std::optional<TimePoint> deadline, std::optional<std::string_view> message,
                                        Wake wake) const;

 private:
  template <class Request>
  using Method = std::unique_ptr<front::Answer> (OwnAnswers::*)(const Request&, Asked) const;

  template <class Request, Method<Request> kMethod>
  std::unique_ptr<front::Answer> parsed(std::optional<std::string_view> message, Asked asked) const;

  std::unique_ptr<front::Answer> stop(const v1::StopRequest& request, Asked asked) const;
  std::unique_ptr<front::Answer> emergency_stop(const v1::EmergencyStopRequest& request, Asked asked) const;
  std::unique_ptr<front::Answer> abort_job(const v1::AbortJobRequest& request, Asked asked) const;
  std::unique_ptr<front::Answer> list_devices(const v1::ListDevicesRequest& request, Asked asked) const;
  std::unique_ptr<front::Answer> get_device(const v1::GetDeviceRequest& request, Asked asked) const;
  std::unique_ptr<front::Answer> execute(const v1::ExecuteRequest& request, Asked asked) const;

  const server::Gateway& gateway_;
  const api::Api& api_;
};

}  // namespace axisgate::rpc
