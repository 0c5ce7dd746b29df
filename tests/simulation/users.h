// Twenty people and scripts who share one stage under leases: they crash, pause, come back with stale tokens, overlap,
// take over and stop one another. A separate ledger, which knows nothing of server/access, decides who may move which
// axes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/access/leases.h"
#include "tests/simulation/world.h"

namespace axisgate::simulation {

class Users {
 public:
  static constexpr int kUsers = 20;
  static constexpr std::int64_t kTravel = 20'000;  // pulses, in either direction

  Users(std::uint64_t seed, const Faults& faults);

  void act_for(Duration duration);
  World& world() { return world_; }

  struct Counts {
    int granted = 0, refused = 0, expired = 0, taken_over = 0, handed_over = 0, latched = 0, moved = 0, jogged = 0,
        executed = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  struct User {
    std::string name;
    server::LeaseToken token = 0;
    std::vector<server::LeaseToken> stale;
    TimePoint paused_until{};
    stage::MotionId jog = 0;  // the jog that the user renews
  };
  // A granted lease in the ledger.
  struct Grant {
    std::string who;
    stage::AxisSet axes;
    Duration time_to_live{};
    TimePoint valid_until{};
    server::AtLoss at_loss = server::AtLoss::stop;
    stage::AxisSet latched;
    stage::AxisSet latched_by_others;  // latched axes whose latch outlives the lease
    bool sped = false;                 // the holder has set speeds
    bool wired = false;                // the holder has set outputs or a trigger
    bool over = false;                 // released, handed over or taken over
    std::uint64_t epoch = 0;
  };

  void act(User& user);
  void acquire(User& user);
  void take_over(User& user);
  void keep_alive(User& user);
  void disconnect(User& user);
  void crash(User& user);
  void move(User& user, server::LeaseToken token);
  void path(User& user, server::LeaseToken token);
  void jog(User& user, server::LeaseToken token);
  void keep_jogs();
  void execute(User& user, server::LeaseToken token);
  void stop(User& user);
  void rearm(User& user);
  server::LeaseTerms drawn_terms();
  use::RequestContext context(const User& user, server::LeaseToken token);
  server::LeaseToken drawn_token(const User& user);
  void granted(User& user, const server::Lease& lease);
  void on_news(const stage::Event& event);
  void check_bytes(const stage::BytesWritten& written);
  void check_travel();
  void check_speeds(const stage::BytesWritten& written);
  void check_outputs(const stage::BytesWritten& written);
  void check_jogs();
  bool owned(const Grant& grant);
  const Grant* owner_of(int axis);

  server::LeaseTokens tokens_{1};
  server::Leases leases_{tokens_};
  World world_;
  std::vector<User> users_;
  std::map<server::LeaseToken, Grant> grants_;
  std::map<std::string, stage::AxisSet> held_back_;
  std::map<stage::MotionId, server::LeaseToken> leases_of_;  // lease under which each motion was requested
  server::LeaseToken asking_ = 0;
  std::map<stage::MotionId, TimePoint> renewed_;  // last renewal of each jog
  Counts counts_;
};

}  // namespace axisgate::simulation
