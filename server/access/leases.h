// Leases of one device: the holders of its axes, the callers who wait, and those whom a stop holds back.
//
//   acquire ──► waiting ──► held ──► (released, expired, taken over, device restarted) ──► ending ──► gone
//                  │           ▲                                                             │
//               abandoned      └── keep_alive      no motion of it is left, settings restored ──────┘
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/use/permission.h"
#include "server/access/lease.h"
#include "server/access/lease_tokens.h"
#include "server/limits.h"

namespace axisgate::server {

using use::ActivityId;

// Not thread safe: lives on its device's strand. Stops nothing by itself: advance() returns the stops to be sent.
class Leases : public use::Permission {
 public:
  static constexpr std::size_t kWaitingMax = 256;

  explicit Leases(LeaseTokens& tokens) : tokens_(tokens) {}

  // Answers once: with the lease; with lease_held if `wait` is false; with deadline_passed or queue_full; or with
  // not_sent after withdraw(). lease_held and deadline_passed name the obstacle: a holder, a waiting caller, or a
  // motion without a lease. Returns the id of the waiting lease, or 0 if it was answered at once.
  using OnLease = std::function<void(Result<Lease>)>;
  std::uint64_t acquire(LeaseTerms terms, const std::string& holder, bool wait, TimePoint not_after, TimePoint now,
                        OnLease answer);
  void withdraw(std::uint64_t waiting, TimePoint now);

  // Extends the lease by another time_to_live from now on. Fails with lease_lost.
  Result<Lease> keep_alive(LeaseToken token, TimePoint now);
  // Handles the loss of the connection that kept the lease alive, as AtLoss says.
  void lost(LeaseToken token, TimePoint now);
  // Ends all leases of `holder`, whose token `by` has revoked, and withdraws the requests of `holder` that wait. Motion
  // under the leases is stopped, unless a lease lets it finish.
  void cut_off(const std::string& holder, const std::string& by, TimePoint now);
  // Ends the lease. Its running motion continues to its end, and the axes are free then. Fails with lease_lost.
  Result<void> release(LeaseToken token, TimePoint now);
  // Gives the axes to the first waiting caller named `to` who needs no other axes, before all other callers. Fails with
  // lease_lost; with axis_busy while a motion runs under the lease; and with not_found if no such caller waits.
  Result<void> hand_over(LeaseToken token, const std::string& to, TimePoint now);
  // Stops all motion on these axes, no matter who started it, and takes the axes from all other callers.
  void take_over(LeaseTerms terms, const std::string& holder, TimePoint now, OnLease answer);

  // Lifts the latches that hold `who` back, those of the leases of `who`, and that of the lease with the token, if
  // there is one. Returns the lifted latches.
  std::vector<Latch> rearm(LeaseToken token, const std::string& who, TimePoint now);

  std::vector<Lease> held() const;  // with ending ones; oldest first
  std::vector<WaitingLease> waiting(TimePoint now) const;
  // A HeldBack is a caller whose motion or lease another caller stopped. Anonymous callers are held back with each of
  // them, because any anonymous caller may be the stopped one.
  struct HeldBack {
    std::string who;
    Latch latch;
    bool anonymous = true;  // holds back anonymous callers, too; false once one of them has rearmed
  };
  const std::vector<HeldBack>& held_back() const { return held_back_; }

  // Called after every change of the values that the functions above return. Must not call back.
  std::function<void(TimePoint now)> on_change;
  // Called with each grant, end, latch and rearm, in their order. Must not call back.
  std::function<void(const LeaseEvent& event, TimePoint now)> on_event;

  Result<void> authorize(const use::Use& use, TimePoint now) override;
  void begin(const use::Use& use, use::Occupation occupation, TimePoint now) override;
  void due(ActivityId activity, TimePoint over) override;
  void end(ActivityId activity, TimePoint now) override;
  void stop_asked(const use::Use& stop, const std::vector<use::Use>& waiting, TimePoint now) override;
  void device_restarted(TimePoint now) override;
  void settings_changed(LeaseToken lease) override;
  use::Orders advance(TimePoint now) override;
  void stopped(std::uint64_t order, TimePoint now) override;
  void settings_restored(LeaseToken lease, TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

 private:
  enum class Settings { untouched, changed, being_restored };
  struct Held {
    Lease lease;
    bool continues = false;  // of an ending lease: its running motion may send until it has ended
    Settings settings = Settings::untouched;
  };
  struct Waiting {
    WaitingLease lease;
    TimePoint not_after{};
    OnLease answer;
    std::uint64_t order = 0;  // stop order of a take-over until it was answered; else 0
    bool takes_over = false;
  };
  struct Running {
    use::Use use;
    use::Occupation occupation;
    bool revoked = false;  // taken over: not a byte more may be sent
  };
  struct Mover {  // caller that has recently moved something
    use::Use use;
    TimePoint until{};
  };

  Held* find(LeaseToken token);
  Result<Held*> find_held(LeaseToken token, TimePoint now);
  Problem lost_problem(LeaseToken token) const;
  Result<void> authorize_leased(const use::Use& use, TimePoint now);
  Result<void> may_borrow(const use::Use& use, TimePoint now);
  void note_mover(use::Use use, TimePoint now);
  bool hold_back(const std::string& who, const Latch& latch);
  std::optional<Problem> held_problem(Scope scope, TimePoint now) const;
  std::optional<Problem> in_the_way(Scope scope, TimePoint now) const;
  bool runs(LeaseToken token) const;
  void end_lease(Held& held, LeaseEnding ending, bool continues, TimePoint now);
  void end_unkept(Held& held, LeaseEnding ending, TimePoint now);
  void order_stop(Scope scope, const std::string& who);
  void expire(TimePoint now);
  void settle(TimePoint now);
  bool drop_ended();
  bool is_over(Held& held);
  bool grant(TimePoint now);
  Scope taken() const;
  Lease start(const Waiting& waiting, TimePoint now);
  std::optional<Duration> expected_wait(std::size_t place, TimePoint now) const;
  void changed(TimePoint now) const {
    if (on_change) on_change(now);
  }
  void report(const LeaseEvent& event, TimePoint now) const {
    if (on_event) on_event(event, now);
  }

  static constexpr std::size_t kEndedKept = 64, kHeldBackMax = 4096;

  LeaseTokens& tokens_;
  std::vector<Held> held_;
  std::deque<Waiting> waiting_;
  std::map<ActivityId, Running> running_;
  std::vector<Mover> movers_;
  std::vector<HeldBack> held_back_;
  struct Ended {
    LeaseToken token = 0;
    LeaseEnding ending;
  };
  std::deque<Ended> ended_;
  use::Orders orders_;
  std::uint64_t last_waiting_ = 0, last_order_ = 0;
};

}  // namespace axisgate::server
