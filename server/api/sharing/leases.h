// Who may move what: leases, and stops that stay stopped.
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

// A lease as its holder wants it.
struct LeaseWish {
  stage::AxisSet axes{};                   // none: all
  std::optional<Duration> time_to_live{};  // 1 s to a day; nothing: 10 s
  server::AtLoss at_loss = server::AtLoss::stop;
  std::optional<Duration> expected_use{};  // a year at most
  std::string purpose{};                   // at most 200 printable ASCII characters
};

// A caller who waits for a lease and may go meanwhile. Thread safe; kept until the answer.
class LeaseSeeker {
 public:
  virtual ~LeaseSeeker() = default;

  // Once, from any thread. Nothing: it was to be checked only. False: the caller has gone, and the lease is given back.
  virtual bool answer(Result<std::optional<server::Lease>> lease) = 0;
  // `leave` is called once when the caller goes before the answer, at once if that has happened already.
  virtual void when_gone(std::function<void()> leave) = 0;
};

// To what every device has.

using Board = std::shared_ptr<const server::LeaseBoard>;  // never null

// Thread safe. The members' problems are those of DevicePipeline::admit() and of server::Leases.
class Leases {
 public:
  // All outlive this.
  Leases(server::Gateway& gateway, const Admission& admission, const DevicePipeline& pipeline, Streams& streams)
      : gateway_(gateway), admission_(admission), pipeline_(pipeline), streams_(streams) {}

  // Waits for as long as `wait` says, a day at most; 0: not at all. invalid_request.
  void acquire(const Call& call, std::string_view device, const Result<LeaseWish>& wish, Duration wait,
               const std::shared_ptr<LeaseSeeker>& seeker) const;
  void take_over(const Call& call, std::string_view device, const Result<LeaseWish>& wish,
                 const std::shared_ptr<LeaseSeeker>& seeker) const;

  // The lease of these is the call's.
  void release(const Call& call, std::string_view device, Answer<void> answer) const;
  void hand_over(const Call& call, std::string_view device, const std::string& to, Answer<void> answer) const;
  // Answers with what was lifted.
  void rearm(const Call& call, std::string_view device, Answer<std::vector<server::Latch>> answer) const;

  // queue_full.
  Result<std::shared_ptr<LeaseKeeping>> keep_alive(const Call& call) const;
  // Who holds what and who waits, now and at every change; without tokens for no reader to see: the door leaves them
  // out. A slow reader sees fewer changes.
  Opened<Board> watch(const Call& call, std::string_view device) const;

 private:
  server::Gateway& gateway_;
  const Admission& admission_;
  const DevicePipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
