// Lease that lasts as long as its object: acquired, kept alive, and released.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

class HeldLease {
 public:
  // Acquires a lease over the named or numbered axes; none means the whole device. The options --wait, --take-over
  // and --purpose apply. `at_loss` is what happens to motion when axisctl is killed or cut off. Throws Failure.
  HeldLease(const Session& session, const v1::Device& device, const std::vector<std::string>& axes, v1::AtLoss at_loss);
  // Releases the lease. A motion that was started under it runs to its end.
  ~HeldLease();
  HeldLease(const HeldLease&) = delete;
  HeldLease& operator=(const HeldLease&) = delete;

  const v1::Lease& lease() const { return lease_; }

 private:
  void keep_alive();
  bool wait_until_due();

  const Session& session_;
  const std::string device_;
  v1::Lease lease_;
  std::mutex mutex_;
  std::condition_variable ended_changed_;
  bool ended_ = false;
  std::atomic<bool> lost_ = false;
  std::thread keeper_;
};

}  // namespace axisgate::axisctl
