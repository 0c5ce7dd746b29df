// Limit of open streams over all callers and doors, and the caller of each.
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

// A StreamCut says how the daemon ends a stream.
struct StreamCut {
  Problem why;
  bool after_what_is_due = false;  // the reader still receives the items that are due at that time
};

// An OpenStream is one open stream. Thread safe.
class OpenStream {
 public:
  // Calls `then` once, on the thread that ends the stream; immediately if the stream was already ended.
  void on_cut_off(std::function<void()> then);
  // Returns how the daemon ended the stream; nullopt while it may continue.
  std::optional<StreamCut> cut_off() const;
  // Ends the stream. Only the first call counts.
  void cut_off(StreamCut cut);

 private:
  mutable std::mutex mutex_;
  std::unique_ptr<const StreamCut> cut_;  // null for most streams, of which there are thousands
  std::function<void()> then_;
};

// Thread safe.
class Streams {
 public:
  static constexpr int kStreamsMax = 4096;
  // Reserved for streams that follow one motion, so that other streams never keep a caller from the outcome of a move.
  static constexpr int kOutcomesKept = 512;
  // Lower than the limit of other streams, because a path takes up to tens of megabytes of memory.
  static constexpr int kPathsMax = 32;
  static constexpr int kPathsOfOneMax = 8;  // per caller

  struct Limits {
    int streams = kStreamsMax;  // total
    int outcomes_kept = kOutcomesKept;
    int paths = kPathsMax;
    int paths_of_one = kPathsOfOneMax;
  };

  Streams() : Streams(Limits()) {}
  explicit Streams(const Limits& limits) : limits_(limits), open_(std::make_shared<Open>()) {}

  // A Place counts one open stream until its last copy is destroyed. May outlive the Streams.
  using Place = std::shared_ptr<OpenStream>;

  // Takes a place for the caller, by the quota of the kind. Fails with queue_full if no place is left, and with
  // daemon_ending after end_all().
  Result<Place> take(RequestKind kind, const std::string& who);

  // Ends all streams that the caller has open at this time.
  void cut_off(const std::string& who, const Problem& why);

  // Ends all streams with daemon_ending, after the items that are due. Later streams are refused.
  void end_all();
  // Returns daemon_ending after end_all(), and nullopt before.
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
