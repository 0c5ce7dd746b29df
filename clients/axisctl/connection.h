// The way to the daemon. Every failed call becomes a Failure that says what to do.
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
#include "clients/axisctl/options.h"
#include "clients/axisctl/upload_steps.h"

namespace axisgate::axisctl {

// Starting a motion may first wait for its turn, at most 5 s (CallContext.not_after).
inline constexpr std::chrono::seconds kQuestionLimit{5};
inline constexpr std::chrono::seconds kStartLimit{10};
// The daemon answers a stop within this time, with what it knows by then. An axis at full speed may take a second to
// slow down (manual 89) R).
inline constexpr std::chrono::seconds kStopWait{3};
// Longer than kStopWait, because the daemon may be flooded.
inline constexpr std::chrono::seconds kStopLimit{30};

class Connection {
 public:
  // Calls as the token in AXISGATE_TOKEN, if there is one. Shares nothing with other connections of this process, so
  // that a stop never waits behind a stream. Throws Failure where a certificate cannot be read. `request_id` is that of
  // what is changed; empty: a new one for each.
  explicit Connection(const Target& target, std::string request_id = {});

  // A context with the request id, and with the token in AXISGATE_LEASE. Throws Failure where that is no token.
  v1::CallContext new_call_context() const;

  // From now on what changes something is repeated where its answer is lost, if the daemon keeps what became of it.
  void repeat_by(const v1::ListDevicesResponse& there) const;

  bool repeats() const { return !request_memory_.empty(); }

  // A call with a deadline, over all attempts. Throws Failure.
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

  // The same for a request in several messages, of which the first has the context; there is at least one. UploadSteps
  // limits the time of each message and of the answer.
  template <class Stub, class Request, class Response>
  Response upload(const std::unique_ptr<Stub>& stub,
                  std::unique_ptr<grpc::ClientAsyncWriter<Request>> (Stub::*method)(grpc::ClientContext*, Response*,
                                                                                    grpc::CompletionQueue*),
                  std::vector<Request> messages) const {
    messages.front().mutable_context()->set_request_memory(request_memory_);
    std::size_t bytes = 0;
    for (const Request& message : messages) bytes += message.ByteSizeLong();
    return attempt<Response>(true, upload_limit(bytes), [&](grpc::ClientContext& context, Response& response) {
      UploadSteps steps(context);
      return steps.run(*(stub.get()->*method)(&context, &response, steps.queue()), messages);
    });
  }

  // Throws Failure unless the call ended well.
  void check(const grpc::Status& status) const;

  const std::string& target() const { return target_; }  // its address

 private:
  // Attempts until one is answered; more than one only of what `changes` something. Throws Failure.
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

  // Whether the answer was lost, and it is worth another attempt.
  bool asks_again(const grpc::Status& status, std::chrono::system_clock::time_point deadline) const;

  const std::string target_, request_id_;
  mutable std::string request_memory_;  // empty: nothing is repeated
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

// What the daemon said of an error; reason REASON_UNSPECIFIED when it said nothing.
v1::Problem problem_of(const grpc::Status& status);

// The variable that holds the token of the lease under which a command was started by `lease run`.
inline constexpr const char* kLeaseVariable = "AXISGATE_LEASE";

// The token as the variable holds it, in hexadecimal.
std::string lease_text(std::string_view token);

// A context with a new request id, and with the token in AXISGATE_LEASE if that is one: nothing holds a stop up.
v1::CallContext new_stop_context();

}  // namespace axisgate::axisctl
