// Twenty users who repeat what they request: their answers are lost, their messages come twice, late and in another
// order, and the daemon is killed between. A ledger of its own says what the controller was sent of each request, and
// the simulator where its axes were.
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
  // The line is made perfect, every motion ends, and what is on file is compared.
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
  using Places = std::array<std::int64_t, stage::kAxisCount>;

  // What a user wants done. Its ways, in pulses, are no other's.
  struct Wanted {
    std::string who, id;
    api::RequestKind kind{};
    std::vector<std::pair<int, std::int64_t>> ways{};  // axis and way; one of 0 where the kind has none
    std::string mark{};

    Key key() const { return {who, id}; }
    std::string digest() const;
  };
  // One attempt at it.
  struct Message {
    Wanted wanted;
    stage::RequestContext context;
    std::uint64_t sequence = 0;
    bool outdated = false;  // its lease is of a run that was killed
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
  // What is known of an id, whatever was requested under it.
  struct Acted {
    std::set<stage::MotionId> written;      // its motions of which a line has gone out
    std::optional<stage::MotionId> motion;  // as it was answered
    int firsts = 0;                         // answers that were not marked as repeated
    std::string answer;                     // of Execute
    std::uint64_t newest = 0;               // the last of its messages that came
  };
  struct MotionFacts {
    MessagePtr message;  // null: nobody's
    bool written = false;
    bool start_written = false;
    std::optional<Places> from{};  // where the axes were when its first line was written
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
  void check_way(const stage::Motion& motion, const MotionFacts& facts);
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
  MessagePtr asking_;  // while the controller is asked
  std::int64_t last_way_ = 0;
  std::uint64_t last_sequence_ = 0;
  int lines_to_hang_ = 0, lines_to_kill_ = 0;  // 0: none is due
  std::set<std::int64_t> started_;             // ways, of which the controller received the start
  Counts counts_;
};

}  // namespace axisgate::simulation
