// Leases, and the latches that stops set.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "server/access/leases.h"
#include "server/api/request/call.h"
#include "server/api/request/pipeline.h"
#include "server/api/request/subscription.h"
#include "server/api/sharing/lease_keeping.h"
#include "server/devices/device.h"
#include "server/gateway.h"

namespace axisgate::api {

// A LeaseWish describes the lease that a caller requests.
struct LeaseWish {
  stage::AxisSet axes{};                   // of a stage; empty: the whole device
  std::optional<Duration> time_to_live{};  // 1 s to 24 h; nullopt: 10 s
  server::AtLoss at_loss = server::AtLoss::stop;
  std::optional<Duration> expected_use{};  // at most 365 days
  std::string purpose{};                   // at most 200 printable ASCII characters
};

// A LeaseSeeker is a caller who waits for a lease and may disconnect meanwhile. Thread safe; kept until the answer.
class LeaseSeeker {
 public:
  virtual ~LeaseSeeker() = default;

  // Delivers the answer; called once, from any thread. `lease` is nullopt after a check with validate_only. Returns
  // false if the caller has disconnected; the lease is then released.
  virtual bool answer(Result<std::optional<server::Lease>> lease) = 0;
  // Registers `leave`, which is called once if the caller disconnects before the answer; immediately if that has
  // already happened.
  virtual void when_gone(std::function<void()> leave) = 0;
};

using Board = std::shared_ptr<const server::LeaseBoard>;  // never null

// Thread safe. The members fail as DevicePipeline::admit() and server::Leases do.
class Leases {
 public:
  // The referenced objects must outlive this one.
  Leases(server::Gateway& gateway, const Admission& admission, const DevicePipeline& pipeline, Streams& streams)
      : gateway_(gateway), admission_(admission), pipeline_(pipeline), streams_(streams) {}

  // Waits for the lease for at most `wait`, at most 24 h; 0: does not wait. Fails with invalid_request.
  void acquire(const Call& call, std::string_view device, const Result<LeaseWish>& wish, Duration wait,
               const std::shared_ptr<LeaseSeeker>& seeker) const;
  void take_over(const Call& call, std::string_view device, const Result<LeaseWish>& wish,
                 const std::shared_ptr<LeaseSeeker>& seeker) const;

  // renew(), release() and hand_over() act on the lease of the call.
  void renew(const Call& call, std::string_view device, Answer<server::Lease> answer) const;
  void release(const Call& call, std::string_view device, Answer<void> answer) const;
  void hand_over(const Call& call, std::string_view device, const std::string& to, Answer<void> answer) const;
  // Answers with the latches that have ended.
  void rearm(const Call& call, std::string_view device, Answer<std::vector<server::Latch>> answer) const;

  // Fails with queue_full.
  Result<std::shared_ptr<LeaseKeeping>> keep_alive(const Call& call) const;
  // Streams the holders and the waiting callers, now and at every change. The door leaves out the tokens, which no
  // reader may see. A slow reader sees fewer changes.
  Opened<Board> watch(const Call& call, std::string_view device) const;

 private:
  server::Gateway& gateway_;
  const Admission& admission_;
  const DevicePipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
