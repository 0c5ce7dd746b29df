// Who holds which axes of one device, who waits for them, and whom a stop holds back.
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
#include "device/stage/permission.h"
#include "server/access/lease.h"
#include "server/access/lease_tokens.h"

namespace axisgate::server {

using stage::MotionId;

// Not thread safe: lives on its device's strand. It moves nothing itself: what must stop is fetched by advance().
class Leases : public stage::Permission {
 public:
  static constexpr std::size_t kWaitingMax = 256;

  explicit Leases(LeaseTokens& tokens) : tokens_(tokens) {}

  // Answers once: with the lease, or with lease_held where `wait` is false, deadline_passed, queue_full, or not_sent
  // when withdrawn. The first two name what is in the way: a holder, one who waits, or a motion without a lease. The id
  // is that of the waiting one, 0 when it was answered at once.
  using OnLease = std::function<void(Result<Lease>)>;
  std::uint64_t acquire(LeaseTerms terms, const std::string& holder, bool wait, TimePoint not_after, TimePoint now,
                        OnLease answer);
  void withdraw(std::uint64_t waiting, TimePoint now);

  // Another time_to_live from now on. lease_lost.
  Result<Lease> keep_alive(LeaseToken token, TimePoint now);
  // The connection over which it was kept alive broke; AtLoss says what follows.
  void lost(LeaseToken token, TimePoint now);
  // The token of this holder was revoked by another: its leases end, and so does its waiting. What moves under them is
  // stopped, except where a lease lets it finish.
  void cut_off(const std::string& holder, const std::string& by, TimePoint now);
  // What runs under it runs to its end, and the axes are free then. lease_lost.
  Result<void> release(LeaseToken token, TimePoint now);
  // To the first of that name who waits for nothing but these axes, past all others. lease_lost, axis_busy while a
  // motion runs under it, not_found when nobody of that name waits.
  Result<void> hand_over(LeaseToken token, const std::string& to, TimePoint now);
  // Stops all motion on these axes, no matter who started it, and takes the axes from all others.
  void take_over(LeaseTerms terms, const std::string& holder, TimePoint now, OnLease answer);

  // Lifts the latches that hold `who` back, those of the leases of `who`, and that of the lease with the token, if
  // there is one. Answers with what was lifted.
  std::vector<Latch> rearm(LeaseToken token, const std::string& who, TimePoint now);

  std::vector<Lease> held() const;  // those that are ending among them; oldest first
  std::vector<WaitingLease> waiting(TimePoint now) const;
  // Somebody whose motion, or whose lease, another stopped. Anonymous callers are held back with
  // everybody, since each of them may be the one.
  struct HeldBack {
    std::string who;
    Latch latch;
    bool anonymous = true;  // until one of the anonymous rearms
  };
  const std::vector<HeldBack>& held_back() const { return held_back_; }

  // Called after every change of what the members above tell. Must not call back.
  std::function<void(TimePoint now)> on_change;
  // Called with each grant, end, latch and rearm, in their order. Must not call back.
  std::function<void(const LeaseEvent& event, TimePoint now)> on_event;

  Result<void> authorize(const stage::Use& use, TimePoint now) override;
  void begin(const stage::Use& use, stage::Occupation occupation, TimePoint now) override;
  void due(MotionId motion, TimePoint over) override;
  void end(MotionId motion, TimePoint now) override;
  void stop_asked(const stage::Use& stop, const std::vector<stage::Use>& waiting, TimePoint now) override;
  void device_restarted(TimePoint now) override;
  void settings_changed(LeaseToken lease) override;
  stage::Orders advance(TimePoint now) override;
  void stopped(std::uint64_t order, TimePoint now) override;
  void settings_restored(LeaseToken lease, TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

 private:
  enum class Settings { untouched, changed, being_restored };
  struct Held {
    Lease lease;
    bool continues = false;  // of an ending one: what runs may send on until it has ended
    Settings settings = Settings::untouched;
  };
  struct Waiting {
    WaitingLease lease;
    TimePoint not_after{};
    OnLease answer;
    std::uint64_t order = 0;  // of a take-over: its stop, until that has been answered
    bool takes_over = false;
  };
  struct Running {
    stage::Use use;
    stage::Occupation occupation;
    bool revoked = false;  // taken over: not a byte more
  };
  struct Mover {  // moved something a moment ago
    stage::Use use;
    TimePoint until{};
  };

  Held* find(LeaseToken token);
  Result<Held*> find_held(LeaseToken token, TimePoint now);
  Problem lost_problem(LeaseToken token) const;
  Result<void> authorize_leased(const stage::Use& use, TimePoint now);
  Result<void> may_borrow(const stage::Use& use, TimePoint now);
  void note_mover(stage::Use use, TimePoint now);
  bool hold_back(const std::string& who, const Latch& latch);
  std::optional<Problem> held_problem(AxisSet axes, TimePoint now) const;
  std::optional<Problem> in_the_way(AxisSet axes, TimePoint now) const;
  bool runs(LeaseToken token) const;
  void end_lease(Held& held, LeaseEnding ending, bool continues, TimePoint now);
  void end_unkept(Held& held, LeaseEnding ending, TimePoint now);
  void order_stop(AxisSet axes, const std::string& who);
  void expire(TimePoint now);
  void settle(TimePoint now);
  bool drop_ended();
  bool is_over(Held& held);
  bool grant(TimePoint now);
  AxisSet taken() const;
  Lease start(const Waiting& waiting, TimePoint now);
  std::optional<Duration> expected_wait(std::size_t place, TimePoint now) const;
  void changed(TimePoint now) const {
    if (on_change) on_change(now);
  }
  void report(const LeaseEvent& event, TimePoint now) const {
    if (on_event) on_event(event, now);
  }

  static constexpr std::size_t kEndedKept = 64, kHeldBackMax = 4096;
  // A loop is between two motions for so long at most.
  static constexpr Duration kMovedLately = std::chrono::seconds(10);

  LeaseTokens& tokens_;
  std::vector<Held> held_;
  std::deque<Waiting> waiting_;
  std::map<MotionId, Running> running_;
  std::vector<Mover> movers_;
  std::vector<HeldBack> held_back_;
  struct Ended {
    LeaseToken token = 0;
    LeaseEnding ending;
  };
  std::deque<Ended> ended_;
  stage::Orders orders_;
  std::uint64_t last_waiting_ = 0, last_order_ = 0;
};

}  // namespace axisgate::server
