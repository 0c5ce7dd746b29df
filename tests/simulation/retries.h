// Twenty users who repeat their requests: answers are lost, messages arrive twice, late and in another order, and the
// daemon is killed in between. A separate ledger records the lines sent to the controller for each request, and the
// simulator's axis positions.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/api/request/request_kinds.h"
#include "tests/simulation/daemon.h"
#include "tests/simulation/world.h"

namespace axisgate::simulation {

struct RetryTerms {
  Faults faults;
  server::journal::MemoryBounds bounds{};
  bool marks = true;  // requests carry CallContext.request_memory
  bool kills = true;
};

class Retries {
 public:
  static constexpr int kUsers = 20;

  Retries(std::uint64_t seed, const RetryTerms& terms);

  void act_for(Duration duration);
  // Makes the line perfect, waits for the end of every motion, and checks the files.
  void become_stationary();
  World& world() { return world_; }

  struct Counts {
    int requested = 0, repeated = 0, reordered = 0, reused = 0, duplicated = 0, stale = 0, late = 0, succeeded = 0,
        executed = 0, kills = 0, kills_in_motion = 0, hangs = 0, refused_by_disk = 0, never_sent = 0, unknown = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  using Key = server::journal::RequestMemory::Key;
  using Known = server::journal::RequestMemory::Known;
  using Places = std::array<std::int64_t, shrc203::kAxisCount>;

  // A request of one user. Its displacements, in pulses, are unique.
  struct Wanted {
    std::string who, id;
    api::RequestKind kind{};
    std::vector<std::pair<int, std::int64_t>> ways{};  // axis and displacement; one entry with 0 if the kind has none
    std::string mark{};

    Key key() const { return {who, id}; }
    std::string digest() const;
  };
  // One attempt at a request.
  struct Message {
    Wanted wanted;
    use::RequestContext context;
    std::uint64_t sequence = 0;
    bool outdated = false;  // its lease belongs to a run that was killed
  };
  using MessagePtr = std::shared_ptr<const Message>;
  struct Granted {
    server::LeaseToken token = 0;  // 0: none
    std::uint32_t run = 0;
  };
  struct User {
    std::string name;
    std::vector<Wanted> wanted{};
    Granted lease{};
    std::vector<Granted> old_leases{};
  };
  // Facts about an id, for all requests under it.
  struct Acted {
    std::set<stage::MotionId> written;      // motions of this id with a line sent
    std::optional<stage::MotionId> motion;  // as answered
    int firsts = 0;                         // answers that were not marked as repeated
    std::string answer;                     // answer to Execute
    std::uint64_t newest = 0;               // sequence of the newest message received
  };
  struct MotionFacts {
    MessagePtr message;  // null: no user's motion
    bool written = false;
    bool start_written = false;
    std::optional<Places> from{};  // positions of the axes when the motion's first line was written
    std::optional<stage::MotionState> outcome{};
    Places ended_at{};
    bool may_lack_rows = false;  // the disk hung, or the daemon was killed
  };

  void act(User& user);
  Wanted drawn_request(const User& user);
  void request_newly(User& user);
  void retry(User& user);
  void reuse(User& user);
  void duplicate(User& user);
  void use_leases(User& user);
  void send(const User& user, const Wanted& wanted, Duration delay);
  Granted drawn_lease(const User& user);
  Duration drawn_delay();
  void later(Duration delay, std::function<void()> deed);

  void arrive(const MessagePtr& message);
  void begin(const MessagePtr& message, const std::shared_ptr<Mutation>& mutation);
  void execute(const MessagePtr& message, const std::shared_ptr<Mutation>& mutation);
  void repeat(const MessagePtr& message, const Result<Known>& known);
  void refuse(const MessagePtr& message, Mutation& mutation, const Problem& problem);
  void answered(const Wanted& wanted, stage::MotionId motion, bool repeated);
  void count(const Problem& problem);

  void plan_kill();
  void come_closer_to_kill();
  void kill();

  bool anything_moves();
  Places places();
  void on_news(const stage::Event& event);
  void note(const stage::MotionChanged& change);
  void note(const stage::BytesWritten& written);
  void check_approach(const stage::Motion& motion, const MotionFacts& facts);
  void check_answer(const Wanted& wanted, const std::string& answer);
  void check_journal();
  void check_row(const server::journal::StoredEntry& row, std::map<stage::MotionId, int>& last_kinds);
  void check_end(const server::journal::StoredEntry& row, const MotionFacts& facts);
  void check_requests_on_file();
  void check_received();
  void check_starts();
  bool was_started(const MotionFacts& facts) const;

  const RetryTerms terms_;
  StateFolder folder_;
  std::uint32_t run_ = 1;
  std::unique_ptr<Daemon> daemon_;
  World world_;
  std::vector<User> users_;
  std::map<Key, Acted> acted_;
  std::map<stage::MotionId, MotionFacts> motions_;
  MessagePtr asking_;  // the message that the controller is handling
  std::int64_t last_way_ = 0;
  std::uint64_t last_sequence_ = 0;
  int lines_to_hang_ = 0, lines_to_kill_ = 0;  // 0: no hang or kill is due
  std::set<std::int64_t> started_;             // displacements whose start the controller received
  Counts counts_;
};

}  // namespace axisgate::simulation
