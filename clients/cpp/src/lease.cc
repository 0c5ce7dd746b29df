#include "axisgate/lease.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <utility>

#include "clients/cpp/src/lease_keeper.h"
#include "clients/cpp/src/token.h"

namespace axisgate {
namespace client {
namespace {

using google::protobuf::util::TimeUtil;

v1::AcquireLeaseRequest acquire_request(const std::string& device, const LeaseTerms& terms) {
  v1::AcquireLeaseRequest request;
  request.set_device(device);
  for (const std::string& axis : terms.axes) request.mutable_terms()->add_axes(axis);
  *request.mutable_terms()->mutable_time_to_live() = TimeUtil::MillisecondsToDuration(terms.ttl.count());
  request.mutable_terms()->set_purpose(terms.purpose);
  request.mutable_terms()->set_at_loss(terms.finish_at_loss ? v1::AT_LOSS_FINISH : v1::AT_LOSS_STOP);
  if (terms.wait > milliseconds(0)) {
    *request.mutable_wait() = TimeUtil::MillisecondsToDuration(terms.wait.count());
  }
  return request;
}

// Reports whether a renewal that failed may succeed a moment later.
bool passes(const Error& error) {
  return dynamic_cast<const Unavailable*>(&error) != nullptr || error.reason() == "QUEUE_FULL";
}

}  // namespace

LeaseKeeper::LeaseKeeper(std::shared_ptr<DeviceSession> session, const LeaseTerms& terms)
    : session_(std::move(session)),
      ttl_(terms.ttl),
      lease_(session_
                 ->act(session_->services().control, &v1::ControlService::Stub::AcquireLease,
                       acquire_request(session_->device(), terms), terms.wait)
                 .lease()),
      keeper_([this](const std::stop_token& ended) { keep(ended); }) {
  session_->enter_lease(lease_.token());
}

LeaseKeeper::~LeaseKeeper() {
  try {
    release();
  } catch (const Error& error) {
    session_->connection().log(error.what());  // the lease ends when it expires
  }
}

std::exception_ptr LeaseKeeper::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

bool LeaseKeeper::wait_lost(milliseconds limit) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, limit, [this] { return problem_ != nullptr; });
}

void LeaseKeeper::hand_over(const std::string& caller) {
  v1::HandOverLeaseRequest request;
  request.set_device(session_->device());
  request.set_caller(caller);
  Connection& connection = session_->connection();
  connection.act(connection.new_action(lease_.token(), {}), session_->services().control,
                 &v1::ControlService::Stub::HandOverLease, request);
  end();
}

void LeaseKeeper::release() {
  if (!end() || problem()) return;
  v1::ReleaseLeaseRequest request;
  request.set_device(session_->device());
  Connection& connection = session_->connection();
  connection.act(connection.new_action(lease_.token(), {}), session_->services().control,
                 &v1::ControlService::Stub::ReleaseLease, request);
}

bool LeaseKeeper::end() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(ended_, true)) return false;
  }
  keeper_.request_stop();
  keeper_.join();
  session_->leave_lease(lease_.token());
  return true;
}

void LeaseKeeper::keep(const std::stop_token& ended) {
  Clock::time_point kept = Clock::now();
  while (true) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, ended, ttl_ / 3, [] { return false; });
    }
    if (ended.stop_requested()) return;
    try {
      renew();
      kept = Clock::now();
    } catch (const Error& error) {
      if (!passes(error)) return lose(std::current_exception());
      if (Clock::now() - kept <= ttl_) continue;
      return lose(std::make_exception_ptr(
          LeaseLost({.reason = "LEASE_LOST", .message = fmt::format("the lease has expired: {}", error.message())})));
    }
  }
}

void LeaseKeeper::renew() {
  v1::RenewLeaseRequest request;
  request.set_device(session_->device());
  request.mutable_context()->set_lease_token(lease_.token());
  Connection& connection = session_->connection();
  // One attempt: the next renewal is the repeat.
  Repeat once({.until = Clock::now(), .target = connection.address(), .answer = ttl_});
  v1::RenewLeaseResponse response;
  connection.send(session_->services(), once, "RenewLeaseRequest", [&](grpc::ClientContext& context) {
    return session_->services().control.RenewLease(&context, request, &response);
  });
}

void LeaseKeeper::lose(std::exception_ptr why) {
  session_->connection().log("the lease was lost");
  {
    const std::lock_guard lock(mutex_);
    problem_ = std::move(why);
  }
  changed_.notify_all();
}

}  // namespace client

Lease::Lease(std::unique_ptr<client::LeaseKeeper> keeper) : keeper_(std::move(keeper)) {}
Lease::~Lease() = default;
Lease::Lease(Lease&&) noexcept = default;

std::string Lease::token() const { return client::token_text(keeper_->lease().token()); }

std::vector<int> Lease::axes() const { return {keeper_->lease().axes().begin(), keeper_->lease().axes().end()}; }

bool Lease::lost() const { return keeper_->problem() != nullptr; }

bool Lease::wait_lost(std::chrono::milliseconds limit) const { return keeper_->wait_lost(limit); }

std::exception_ptr Lease::problem() const { return keeper_->problem(); }

void Lease::hand_over(const std::string& caller) { keeper_->hand_over(caller); }

void Lease::release() { keeper_->release(); }

}  // namespace axisgate
