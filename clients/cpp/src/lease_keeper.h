// A lease that is acquired, kept alive by a thread, and released.
#pragma once

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "axisgate/lease.h"
#include "axisgate/v1/control.pb.h"
#include "clients/cpp/src/session.h"

namespace axisgate::client {

class LeaseKeeper {
 public:
  // Acquires the lease. Throws LeaseHeld if the axes are not free.
  LeaseKeeper(std::shared_ptr<DeviceSession> session, const LeaseTerms& terms);
  // Releases the lease, if that has not been done.
  ~LeaseKeeper();
  LeaseKeeper(const LeaseKeeper&) = delete;
  LeaseKeeper& operator=(const LeaseKeeper&) = delete;

  const v1::Lease& lease() const { return lease_; }
  std::exception_ptr problem() const;  // null: not lost
  bool wait_lost(milliseconds limit);

  void hand_over(const std::string& caller);
  void release();

 private:
  void keep(const std::stop_token& ended);
  // Renews the lease once. Throws Error.
  void renew();
  void lose(std::exception_ptr why);
  // Ends the keeping and the use of the lease. Returns false if that was done before.
  bool end();

  const std::shared_ptr<DeviceSession> session_;
  const milliseconds ttl_;
  const v1::Lease lease_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::exception_ptr problem_;
  bool ended_ = false;
  std::jthread keeper_;
};

}  // namespace axisgate::client
