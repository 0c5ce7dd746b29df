// The daemon as one program sees it: sends requests and waits; Repeat and Following decide.
#pragma once

#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>

#include "axisgate/stage.h"
#include "clients/cpp/src/following.h"
#include "clients/cpp/src/repeat.h"
#include "clients/cpp/src/services.h"
#include "clients/cpp/src/target.h"

namespace axisgate::client {

// All functions are thread safe. Stops have a connection of their own, which is open from the start, so that no other
// call delays them.
class Connection {
 public:
  explicit Connection(const ConnectOptions& options);

  // A method of a generated stub.
  template <class Stub, class Request, class Response>
  using Method = grpc::Status (Stub::*)(grpc::ClientContext*, const Request&, Response*);

  // Connects for stops, and lists the devices. Throws Unavailable at once if no daemon answers.
  v1::ListDevicesResponse open();

  // Lists the devices.
  v1::ListDevicesResponse list() {
    return ask(services.devices, &v1::DeviceService::Stub::ListDevices, v1::ListDevicesRequest());
  }

  // Returns the answer to a question, which is repeated for `patience` while no daemon answers.
  template <class Stub, class Request, class Response>
  Response ask(Stub& stub, Method<Stub, Request, Response> method, const Request& request, milliseconds patience) {
    Repeat repeat({.until = Clock::now() + patience, .target = target_.address, .answer = half_});
    return send(services, repeat, stub, method, request);
  }
  template <class Stub, class Request, class Response>
  Response ask(Stub& stub, Method<Stub, Request, Response> method, const Request& request) {
    return ask(stub, method, request, half_);
  }

  // Context of a request that acts, and the policy of its repeats.
  struct Action {
    v1::CallContext context;
    Repeat repeat;
  };
  // `patience` is the time that the request may wait for something.
  Action new_action(const std::string& lease_token, milliseconds patience);

  // Sends a request that changes something, so that it acts at most once, and returns its answer.
  template <class Stub, class Request, class Response>
  Response act(Action action, Stub& stub, Method<Stub, Request, Response> method, Request request) {
    *request.mutable_context() = action.context;
    return send(services, action.repeat, stub, method, request);
  }

  // Sends a stop over its own connection. Throws OutcomeUnknown if it cannot be delivered. `method` is a method of
  // StageService.
  template <class Request, class Response>
  Response stop(Method<v1::StageService::Stub, Request, Response> method, const Request& request) {
    Repeat repeat(
        {.until = Clock::now() + half_, .target = target_.address, .answer = half_, .acts = true, .remembered = true});
    try {
      return send(stop_services_, repeat, stop_services_.stage, method, request);
    } catch (const Unavailable& error) {
      throw_undelivered(error);
    }
  }

  // Returns the motion with its outcome, or as it is at `end`. Throws OutcomeUnknown, and Interrupted after `stop`.
  v1::Motion follow(v1::Motion motion, Clock::time_point end, std::stop_token stop);

  // Sends a request until `repeat` ends it. `once` sends it and sets the answer.
  using Once = std::function<grpc::Status(grpc::ClientContext&)>;
  void send(Services& over, Repeat& repeat, std::string_view name, const Once& once);

  void log(std::string_view line) const;

  const std::string& address() const { return target_.address; }
  milliseconds half() const { return half_; }  // half of the time limit of a call

 private:
  template <class Stub, class Request, class Response>
  Response send(Services& over, Repeat& repeat, Stub& stub, Method<Stub, Request, Response> method,
                const Request& request) {
    Response response;
    send(over, repeat, Request::descriptor()->name(),
         [&](grpc::ClientContext& context) { return (stub.*method)(&context, request, &response); });
    return response;
  }

  // Waits; if the call had no connection, at most until there is one.
  static void pause(Services& over, const Failure& failure, milliseconds pause, const std::stop_token& stop = {});

  const Target target_;
  const milliseconds half_;
  const std::function<void(std::string_view)> log_;
  Services stop_services_;

 public:
  Services services;
};

}  // namespace axisgate::client
