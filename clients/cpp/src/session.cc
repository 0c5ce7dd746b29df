#include "clients/cpp/src/session.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <charconv>

#include "clients/cpp/src/motion_handle.h"
#include "clients/cpp/src/outcomes.h"
#include "server/config/default_socket.h"

namespace axisgate::client {
namespace {

constexpr const char* kLeaseVariable = "AXISGATE_LEASE";
constexpr std::size_t kTokenBytes = 24;

}  // namespace

DeviceSession::DeviceSession(std::shared_ptr<Connection> connection, const v1::Device& device)
    : connection_(std::move(connection)), device_(device.name()), axes_(status_of(device).axes) {
  const std::string inherited = environment(kLeaseVariable);
  leases_.push_back(inherited.empty() ? "" : token_bytes(inherited));
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

std::string token_text(std::string_view token) {
  std::string text;
  for (const char byte : token) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

std::string token_bytes(std::string_view text) {
  std::string token;
  for (std::size_t at = 0; at + 2 <= text.size(); at += 2) {
    unsigned char byte = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + 2, byte, 16);
    if (error == std::errc() && end == text.data() + at + 2) token += static_cast<char>(byte);
  }
  if (token.size() != kTokenBytes || text.size() != 2 * kTokenBytes) {
    throw InvalidArgument(
        fmt::format("{} is not the token of a lease: unset it, or use `axisctl lease run`", kLeaseVariable));
  }
  return token;
}

}  // namespace axisgate::client
