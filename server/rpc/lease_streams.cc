#include "server/rpc/lease_streams.h"

#include <utility>

#include "server/rpc/call.h"
#include "server/rpc/lease_news.h"
#include "server/rpc/status.h"

namespace axisgate::rpc {

LeaseWatch* LeaseWatch::start(server::Device& device, StreamLimit::Place place) {
  std::shared_ptr<LeaseWatch> watch(new LeaseWatch(device, std::move(place)));
  watch->open();
  // The subscription ends in closed(), before the watch does.
  watch->subscription_ = device.newest_leases().subscribe([raw = watch.get()] { raw->pump(); });
  watch->pump();
  return watch.get();
}

LeaseWatch::Next LeaseWatch::next() {
  const auto newest = device_.newest_leases().get();
  if (newest.version == sent_) return Wait{};
  sent_ = newest.version;
  return to_proto(*newest.value);
}

LeaseKeeping* LeaseKeeping::start(server::Gateway& gateway, Result<StreamLimit::Place> place) {
  std::shared_ptr<LeaseKeeping> keeping(new LeaseKeeping(gateway));
  keeping->open();
  if (!place) {
    keeping->end(to_status(place.error()));
    return keeping.get();
  }
  keeping->place_ = *std::move(place);
  keeping->StartRead(&keeping->incoming_);
  return keeping.get();
}

// A client that has closed its side in order keeps nothing alive any more, and was not cut off.
void LeaseKeeping::OnReadDone(bool ok) {
  if (!ok) return end(grpc::Status::OK);
  const Result<server::Device*> device = find_device(gateway_, incoming_.device());
  if (!device) return end(to_status(device.error()));
  (*device)->post([keeping = self<LeaseKeeping>(), &device = **device, token = incoming_.lease_token()](
                      stage::StageController&, TimePoint now) { keeping->keep(device, token, now); });
}

void LeaseKeeping::keep(server::Device& device, server::LeaseToken token, TimePoint now) {
  const Result<server::Lease> lease = device.leases().keep_alive(token, now);
  if (!lease) return end(to_status(lease.error()));
  {
    const std::lock_guard lock(mutex_);
    kept_on_ = &device;
    kept_ = token;
    due_.emplace();
    *due_->mutable_lease() = to_proto(*lease);
  }
  pump();
}

// Begun from within gRPC's own callback: elsewhere the call could be over already.
void LeaseKeeping::OnWriteDone(bool ok) {
  if (ok) StartRead(&incoming_);
  PullStream::OnWriteDone(ok);
}

void LeaseKeeping::OnCancel() {
  server::Device* device = nullptr;
  server::LeaseToken token = 0;
  {
    const std::lock_guard lock(mutex_);
    device = std::exchange(kept_on_, nullptr);
    token = kept_;
  }
  if (device != nullptr) {
    device->post([device, token](stage::StageController&, TimePoint now) { device->leases().lost(token, now); });
  }
  PullStream::OnCancel();
}

void LeaseKeeping::end(grpc::Status status) {
  {
    const std::lock_guard lock(mutex_);
    end_ = std::move(status);
  }
  pump();
}

LeaseKeeping::Next LeaseKeeping::next() {
  if (due_) return *std::exchange(due_, std::nullopt);
  if (end_) return *end_;
  return Wait{};
}

}  // namespace axisgate::rpc
