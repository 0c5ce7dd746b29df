// The exclusive right to move some axes.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "axisgate/export.h"

namespace axisgate {

namespace client {
class LeaseKeeper;
}

// LeaseTerms are the terms of a lease.
struct LeaseTerms {
  std::vector<std::string> axes = {};  // names or numbers; empty: the whole device
  std::chrono::milliseconds wait{0};   // longest wait for the axes
  std::chrono::milliseconds ttl{
      10000};                   // time after which the lease ends when the program or the connection has failed
  bool finish_at_loss = false;  // lets a running motion end when the lease is lost; otherwise it is stopped
  std::string purpose = {};     // text for other callers
};

// A Lease is the exclusive right to move some axes, from Stage::lease() until its destruction. A thread keeps it alive.
// Meanwhile all calls of its Stage carry it; of several leases the newest one.
//
// A lease is lost if it cannot be kept alive, or if an administrator takes the axes over. Motion under it then fails
// with LeaseLost. All functions are thread safe.
class AXISGATE_PUBLIC Lease {
 public:
  explicit Lease(std::unique_ptr<client::LeaseKeeper> keeper);
  ~Lease();
  Lease(Lease&&) noexcept;
  Lease& operator=(Lease&&) = delete;

  // Returns the token in hexadecimal. It is a secret: every program that has it in AXISGATE_LEASE can use the lease.
  std::string token() const;
  std::vector<int> axes() const;  // numbers; empty: the whole device

  // Reports whether the lease is lost.
  bool lost() const;
  // Waits until the lease is lost, at most `limit`. Returns lost().
  bool wait_lost(std::chrono::milliseconds limit) const;
  // Returns why the lease was lost. Null: it is not lost.
  std::exception_ptr problem() const;

  // Gives the axes to a waiting caller, such as "unix anna". The lease then ends. Throws Refused if this caller does
  // not wait for exactly these axes, or while a motion runs under the lease.
  void hand_over(const std::string& caller);
  // Ends the lease. A motion that runs under it continues. Has no effect on a lease that has ended. The destructor does
  // the same, but ignores errors: the lease then ends when it expires.
  void release();

 private:
  std::unique_ptr<client::LeaseKeeper> keeper_;
};

}  // namespace axisgate
