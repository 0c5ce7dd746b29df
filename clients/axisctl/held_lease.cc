#include "clients/axisctl/held_lease.h"

#include <fmt/format.h>

#include <chrono>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

// Interval between renewals. A lease of ten seconds survives two late renewals.
constexpr std::chrono::seconds kKeepEvery{3};

v1::LeaseTerms terms(const Session& session, const v1::Device& device, const std::vector<std::string>& axes,
                     v1::AtLoss at_loss) {
  v1::LeaseTerms wanted;
  for (const int axis : find_axes(device, axes)) wanted.add_axes(std::to_string(axis));
  wanted.set_at_loss(at_loss);
  wanted.set_purpose(session.options.purpose);
  return wanted;
}

v1::Lease take_over(const Session& session, const v1::Device& device, const v1::LeaseTerms& wanted) {
  v1::TakeOverLeaseRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  *request.mutable_terms() = wanted;
  return session.connection
      .call(session.connection.control, &v1::ControlService::Stub::TakeOverLease, request, kStopLimit)
      .lease();
}

v1::Lease acquire(const Session& session, const v1::Device& device, const v1::LeaseTerms& wanted) {
  v1::AcquireLeaseRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  *request.mutable_terms() = wanted;
  const auto ask = [&](std::chrono::seconds limit) {
    return session.connection.call(session.connection.control, &v1::ControlService::Stub::AcquireLease, request, limit)
        .lease();
  };
  try {
    return ask(kQuestionLimit);
  } catch (const Failure& held) {
    if (held.reason != "LEASE_HELD" || !session.options.wait_s) throw;
    print_note(held.message + "; waiting");
  }
  const std::chrono::seconds wait{*session.options.wait_s};
  request.mutable_wait()->set_seconds(wait.count());
  return ask(wait + kQuestionLimit);
}

}  // namespace

HeldLease::HeldLease(const Session& session, const v1::Device& device, const std::vector<std::string>& axes,
                     v1::AtLoss at_loss)
    : session_(session),
      device_(device.name()),
      lease_(session.options.take_over ? take_over(session, device, terms(session, device, axes, at_loss))
                                       : acquire(session, device, terms(session, device, axes, at_loss))),
      keeper_([this] { keep_alive(); }) {}

HeldLease::~HeldLease() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ended_changed_.notify_all();
  keeper_.join();
  if (lost_) return;
  v1::ReleaseLeaseRequest request;
  request.mutable_context()->set_lease_token(lease_.token());
  request.set_device(device_);
  try {
    session_.connection.call(session_.connection.control, &v1::ControlService::Stub::ReleaseLease, request,
                             kQuestionLimit);
  } catch (const Failure& failure) {
    print_failure(failure);  // the lease ends when it expires
  }
}

// Waits until the next renewal is due. Returns false if the lease must be released instead.
bool HeldLease::wait_until_due() {
  std::unique_lock lock(mutex_);
  return !ended_changed_.wait_for(lock, kKeepEvery, [this] { return ended_; });
}

void HeldLease::keep_alive() {
  grpc::ClientContext context;
  const auto stream = session_.connection.control->KeepLeaseAlive(&context);
  v1::KeepLeaseAliveRequest request;
  request.set_device(device_);
  request.set_lease_token(lease_.token());
  v1::KeepLeaseAliveResponse response;
  bool kept = true;
  do {
    kept = stream->Write(request) && stream->Read(&response);
  } while (kept && wait_until_due());
  if (kept) {
    stream->WritesDone();
    while (stream->Read(&response)) continue;
    (void)stream->Finish();
    return;
  }
  lost_ = true;
  try {
    session_.connection.check(stream->Finish());
  } catch (const Failure& failure) {
    print_failure(failure);
  }
}

}  // namespace axisgate::axisctl
