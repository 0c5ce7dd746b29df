// The requests for one device, with the lease that they carry.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "axisgate/motion.h"
#include "axisgate/state.h"
#include "clients/cpp/src/connection.h"

namespace axisgate::client {

// All functions are thread safe.
class DeviceSession : public std::enable_shared_from_this<DeviceSession> {
 public:
  // Throws InvalidArgument if AXISGATE_LEASE is not the token of a lease.
  DeviceSession(std::shared_ptr<Connection> connection, const v1::Device& device);

  Connection& connection() const { return *connection_; }
  Services& services() const { return connection_->services; }
  const std::string& device() const { return device_; }  // "devices/stage"
  // Returns the axes as they were when they were first known. Throws Unavailable while they are unknown.
  std::vector<AxisState> axes();

  // Returns the token of the newest lease, or that of `axisctl lease run`. Empty: no lease.
  std::string token() const;
  void enter_lease(const std::string& token);
  void leave_lease(const std::string& token);

  // Sends a request that changes something, under the lease.
  template <class Stub, class Request, class Response>
  Response act(Stub& stub, Connection::Method<Stub, Request, Response> method, Request request,
               milliseconds patience = {}) {
    return connection_->act(connection_->new_action(token(), patience), stub, method, std::move(request));
  }
  // Starts a motion.
  template <class Stub, class Request, class Response>
  Motion start(Stub& stub, Connection::Method<Stub, Request, Response> method, Request request) {
    Connection::Action action = connection_->new_action(token(), {});
    const std::string id = action.context.request_id();
    return own_motion(connection_->act(std::move(action), stub, method, std::move(request)).motion(), id);
  }
  // Starts a motion and waits for its outcome. `stop` cancels the motion; the start itself is awaited, so that it is
  // known whether the motion has started.
  template <class Stub, class Request, class Response>
  MotionResult finish(Stub& stub, Connection::Method<Stub, Request, Response> method, Request request,
                      std::stop_token stop) {
    if (stop.stop_requested()) throw Interrupted("interrupted before the motion was requested");
    return wait_or_cancel(start(stub, method, std::move(request)), std::move(stop));
  }

  Motion to_motion(v1::Motion message);
  // Returns the motion that a request with this id started. Throws OutcomeUnknown if the motion is another one.
  Motion own_motion(v1::Motion message, std::string_view request_id);
  // Returns the state of the device, which is read again if it is older than `max_age`.
  v1::Device read(std::optional<milliseconds> max_age);

 private:
  static MotionResult wait_or_cancel(const Motion& motion, std::stop_token stop);

  const std::shared_ptr<Connection> connection_;
  const std::string device_;
  mutable std::mutex mutex_;
  std::vector<AxisState> axes_;      // empty: unknown
  std::vector<std::string> leases_;  // newest last; the first is that of the environment, which may be empty
};

}  // namespace axisgate::client
