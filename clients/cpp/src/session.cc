#include "clients/cpp/src/session.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>

#include "clients/cpp/src/motion_handle.h"
#include "clients/cpp/src/outcomes.h"
#include "clients/cpp/src/token.h"
#include "server/config/default_socket.h"

namespace axisgate::client {
DeviceSession::DeviceSession(std::shared_ptr<Connection> connection, const v1::Device& device)
    : connection_(std::move(connection)), device_(device.name()), axes_(status_of(device).axes) {
  const std::string inherited = environment(kLeaseVariable);
  leases_.push_back(inherited.empty() ? "" : token_bytes(inherited));
}

std::vector<AxisState> DeviceSession::axes() {
  {
    const std::lock_guard lock(mutex_);
    if (!axes_.empty()) return axes_;
  }
  const Status now = status_of(read(std::nullopt));
  const std::lock_guard lock(mutex_);
  return axes_ = now.known_axes();
}

std::string DeviceSession::token() const {
  const std::lock_guard lock(mutex_);
  return leases_.back();
}

void DeviceSession::enter_lease(const std::string& token) {
  const std::lock_guard lock(mutex_);
  leases_.push_back(token);
}

void DeviceSession::leave_lease(const std::string& token) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find(leases_.begin() + 1, leases_.end(), token);
  if (found != leases_.end()) leases_.erase(found);
}

Motion DeviceSession::to_motion(v1::Motion message) {
  return Motion(std::make_shared<MotionHandle>(shared_from_this(), std::move(message)));
}

Motion DeviceSession::own_motion(v1::Motion message, std::string_view request_id) {
  if (message.request_id() == request_id) return to_motion(std::move(message));
  throw_look_first(fmt::format("the daemon answered with {}, which another request started", message.name()));
}

v1::Device DeviceSession::read(std::optional<milliseconds> max_age) {
  v1::GetDeviceRequest request;
  request.set_device(device_);
  if (max_age) {
    *request.mutable_max_age() = google::protobuf::util::TimeUtil::MillisecondsToDuration(max_age->count());
  }
  return connection_->ask(services().devices, &v1::DeviceService::Stub::GetDevice, request).device();
}

MotionResult DeviceSession::wait_or_cancel(const Motion& motion, std::stop_token stop) {
  try {
    return motion.wait(std::move(stop));
  } catch (const Interrupted&) {
  }
  try {
    motion.cancel();
  } catch (const Error& error) {
    throw_look_first(fmt::format("{} was interrupted, but not cancelled: {}", motion.name(), error.message()));
  }
  throw Interrupted(motion.name() + " is cancelled");
}

}  // namespace axisgate::client
