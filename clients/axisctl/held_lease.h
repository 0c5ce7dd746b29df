// A lease as long as this object lives: acquired, kept alive, given back.
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
  // Over the axes of these names or numbers, none meaning the whole device; else as the options say (--wait,
  // --take-over,
  // --at-loss, --purpose). Throws Failure.
  HeldLease(const Session& session, const v1::Device& device, const std::vector<std::string>& axes);
  // Gives it back. What runs under it runs to its end.
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
