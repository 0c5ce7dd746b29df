// Connection to the daemon. Every failed call becomes a Failure with a hint.
#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "axisgate/v1/access.grpc.pb.h"
#include "axisgate/v1/command.grpc.pb.h"
#include "axisgate/v1/control.grpc.pb.h"
#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/diagnostics.grpc.pb.h"
#include "axisgate/v1/event.grpc.pb.h"
#include "axisgate/v1/history.grpc.pb.h"
#include "axisgate/v1/mill.grpc.pb.h"
#include "axisgate/v1/position.grpc.pb.h"
#include "axisgate/v1/settings.grpc.pb.h"
#include "axisgate/v1/simulator.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"
#include "clients/axisctl/arguments/options.h"
#include "clients/axisctl/upload_steps.h"

namespace axisgate::axisctl {

// Deadlines of calls. kStartLimit is longer because a motion may first wait up to 5 s for its turn
// (CallContext.not_after).
inline constexpr std::chrono::seconds kQuestionLimit{5};
inline constexpr std::chrono::seconds kStartLimit{10};
// Time within which the daemon answers a stop, with what it knows by then. An axis at full speed may take a second to
// slow down (manual 89) R).
inline constexpr std::chrono::seconds kStopWait{3};
// Deadline of a stop. Much longer than kStopWait, because the daemon may be flooded.
inline constexpr std::chrono::seconds kStopLimit{30};

class Connection {
 public:
  // Shares no network connection with other Connections of this process, so that a stop never waits for a stream.
  // `request_id` is used for every mutation; empty: each mutation gets a new id. Throws Failure if a certificate cannot
  // be read, or a token would be sent unencrypted to another machine.
  explicit Connection(const client::Target& target, std::string request_id = {});

  // Returns a context with the request id and the token in AXISGATE_LEASE. Throws Failure if that value is not a token.
  v1::CallContext new_call_context() const;

  // After this call, a mutation whose answer was lost is sent again, provided the daemon remembers request ids.
  void repeat_by(const v1::ListDevicesResponse& there) const;

  bool repeats() const { return !request_memory_.empty(); }

  // Calls the daemon. `limit` covers all attempts. Throws Failure.
  template <class Stub, class Request, class Response>
  Response call(const std::unique_ptr<Stub>& stub,
                grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*), const Request& request,
                std::chrono::seconds limit) const {
    Request repeatable = request;
    constexpr bool changes = requires { repeatable.mutable_context(); };
    if constexpr (changes) repeatable.mutable_context()->set_request_memory(request_memory_);
    return attempt<Response>(changes, limit, [&](grpc::ClientContext& context, Response& response) {
      return (stub.get()->*method)(&context, repeatable, &response);
    });
  }

  // Like call(), for a request in several messages, at least one. The first message has the header. UploadSteps limits
  // the time of each message and of the answer.
  template <class Stub, class Request, class Response>
  Response upload(const std::unique_ptr<Stub>& stub,
                  std::unique_ptr<grpc::ClientAsyncWriter<Request>> (Stub::*method)(grpc::ClientContext*, Response*,
                                                                                    grpc::CompletionQueue*),
                  std::vector<Request> messages) const {
    messages.front().mutable_header()->mutable_context()->set_request_memory(request_memory_);
    std::size_t bytes = 0;
    for (const Request& message : messages) bytes += message.ByteSizeLong();
    return attempt<Response>(true, upload_limit(bytes), [&](grpc::ClientContext& context, Response& response) {
      UploadSteps steps(context);
      return steps.run(*(stub.get()->*method)(&context, &response, steps.queue()), messages);
    });
  }

  // Throws Failure unless the call succeeded.
  void check(const grpc::Status& status) const;

  const std::string& target() const { return target_; }  // address of the daemon

 private:
  // Retries until the daemon answers. Only calls marked `changes` are retried. Throws Failure.
  template <class Response, class Once>
  Response attempt(bool changes, std::chrono::seconds limit, Once once) const {
    const auto deadline = std::chrono::system_clock::now() + limit;
    for (bool again = false;; again = true) {
      grpc::ClientContext context;
      context.set_deadline(deadline);
      context.set_wait_for_ready(again);
      Response response;
      const grpc::Status status = once(context, response);
      if (changes && asks_again(status, deadline)) continue;
      check(status);
      return response;
    }
  }

  // Reports whether the answer was lost and the call should be made again.
  bool asks_again(const grpc::Status& status, std::chrono::system_clock::time_point deadline) const;

  const std::string target_, request_id_;
  mutable std::string request_memory_;  // empty: no call is repeated
  const std::shared_ptr<grpc::Channel> channel_;

 public:
  const std::unique_ptr<v1::DeviceService::Stub> devices;
  const std::unique_ptr<v1::StageService::Stub> stage;
  const std::unique_ptr<v1::EventService::Stub> events;
  const std::unique_ptr<v1::CommandService::Stub> commands;
  const std::unique_ptr<v1::DiagnosticsService::Stub> diagnostics;
  const std::unique_ptr<v1::ControlService::Stub> control;
  const std::unique_ptr<v1::AccessService::Stub> access;
  const std::unique_ptr<v1::SettingService::Stub> settings;
  const std::unique_ptr<v1::SimulatorService::Stub> simulators;
  const std::unique_ptr<v1::PositionService::Stub> positions;
  const std::unique_ptr<v1::HistoryService::Stub> history;
  const std::unique_ptr<v1::MillService::Stub> mills;
};

// Returns the problem that the daemon sent with an error; its reason is REASON_UNSPECIFIED if the daemon sent none.
v1::Problem problem_of(const grpc::Status& status);

// Returns a context with a new request id and the token in AXISGATE_LEASE. An invalid token is left out, so that it
// cannot prevent a stop.
v1::CallContext new_stop_context();

}  // namespace axisgate::axisctl
