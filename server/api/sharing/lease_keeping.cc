#include "server/api/sharing/lease_keeping.h"

#include <utility>

#include "server/api/request/names.h"

namespace axisgate::api {

void LeaseKeeping::keep(std::string_view device, std::string_view lease_token) {
  const Result<server::Device*> found = find_device(gateway_, device);
  if (!found) return end({found.error()});
  const Result<server::LeaseToken> opened = gateway_.lease_tokens().open(lease_token);
  if (!opened) return end({opened.error()});
  (*found)->post([self = self<LeaseKeeping>(), &kept_on = **found, token = *opened](server::Leases&, TimePoint now) {
    self->keep_on(kept_on, token, now);
  });
}

void LeaseKeeping::keep_on(server::Device& device, server::LeaseToken token, TimePoint now) {
  const Result<server::Lease> lease = device.leases().keep_alive(token, now);
  if (!lease) return end({lease.error()});
  {
    const std::lock_guard lock(mutex_);
    kept_on_ = &device;
    kept_ = token;
    due_ = *lease;
  }
  wake();
}

void LeaseKeeping::refuse(const Problem& problem) { end({problem}); }

void LeaseKeeping::finish() { end({}); }

void LeaseKeeping::break_off() {
  server::Device* device = nullptr;
  server::LeaseToken token = 0;
  {
    const std::lock_guard lock(mutex_);
    device = std::exchange(kept_on_, nullptr);
    token = kept_;
  }
  if (device == nullptr) return;
  device->post([token](server::Leases& leases, TimePoint now) { leases.lost(token, now); });
}

void LeaseKeeping::end(StreamEnd end) {
  {
    const std::lock_guard lock(mutex_);
    end_ = std::move(end);
  }
  wake();
}

LeaseKeeping::Reading LeaseKeeping::read() {
  if (due_) {
    server::Lease lease = *std::move(due_);
    due_.reset();
    return lease;
  }
  if (end_) return *end_;
  return Nothing{};
}

}  // namespace axisgate::api
