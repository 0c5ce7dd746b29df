// How many streams may be open at once, over all callers and doors, and whose they are.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "server/api/request/request_kinds.h"

namespace axisgate::api {

// How the daemon ends a stream.
struct StreamCut {
  Problem why;
  bool after_what_is_due = false;  // the reader still receives what the stream has to say at that time
};

// One open stream. Thread safe.
class OpenStream {
 public:
  // `then` is called once, by the thread that ends the stream, or at once where it has been ended already.
  void on_cut_off(std::function<void()> then);
  // How the daemon ended it; nullopt as long as it may continue.
  std::optional<StreamCut> cut_off() const;
  // Ends it. The first time counts.
  void cut_off(StreamCut cut);

 private:
  mutable std::mutex mutex_;
  std::unique_ptr<const StreamCut> cut_;  // null for nearly all, of which there are thousands
  std::function<void()> then_;
};

// Thread safe.
class Streams {
 public:
  static constexpr int kStreamsMax = 4096;
  // Kept for those that follow one motion, so that nobody's dashboards keep a caller from the outcome of a move.
  static constexpr int kOutcomesKept = 512;
  // A path is held whole, up to tens of megabytes: fewer of them than of other streams.
  static constexpr int kPathsMax = 32;
  static constexpr int kPathsOfOneMax = 8;  // of one caller

  struct Limits {
    int streams = kStreamsMax;  // in all
    int outcomes_kept = kOutcomesKept;
    int paths = kPathsMax;
    int paths_of_one = kPathsOfOneMax;
  };

  Streams() : Streams(Limits()) {}
  explicit Streams(const Limits& limits) : limits_(limits), open_(std::make_shared<Open>()) {}

  // Gives its place back when the last copy is gone. May outlive the limit.
  using Place = std::shared_ptr<OpenStream>;

  // One more of this caller, as the quota of the kind has it. queue_full where no place is left;
  // daemon_ending after end_all().
  Result<Place> take(RequestKind kind, const std::string& who);

  // Ends all that this caller has open, from now on.
  void cut_off(const std::string& who, const Problem& why);

  // Ends all streams with daemon_ending, after what is due on them. Later ones are refused.
  void end_all();
  // daemon_ending after end_all(); nullopt before.
  std::optional<Problem> ending() const;

 private:
  struct Counts {
    int streams = 0, outcomes = 0, paths = 0;
  };
  struct Open {
    std::mutex mutex;
    bool ended = false;
    Counts all;
    std::map<std::string, int> paths_by_caller;
    std::multimap<std::string, std::weak_ptr<OpenStream>> by_caller;
  };
  using Entry = std::multimap<std::string, std::weak_ptr<OpenStream>>::iterator;

  std::optional<Problem> full(Quota quota, const std::string& who) const;
  static std::vector<Place> places(Entry begin, Entry end);
  static void count(Open& open, Quota quota, const std::string& who, int one);

  const Limits limits_;
  const std::shared_ptr<Open> open_;
};

}  // namespace axisgate::api
