// Memory of requests by the ids that their callers gave them: a repeated request receives the answer of the first, and
// does not act again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "server/journal/request_table.h"

namespace axisgate::server::journal {

// Limits of age and number of remembered requests. A repeat of a forgotten request would act again, so a caller that
// repeats automatically sends a mark: RequestMemory::mark().
struct MemoryBounds {
  Duration kept = std::chrono::hours(24);
  std::size_t most = 20'000;
};

// Thread safe. Callbacks run within the call that answers them.
class RequestMemory {
 public:
  using Key = std::pair<std::string, std::string>;  // identity and id

  // State of an earlier request.
  struct Known {
    std::string device;
    std::uint64_t motion = 0;  // 0: none
    bool open = false;         // has not ended
    std::string answer;        // answer; for an open motion, its state when it was created
  };
  using OnKnown = std::function<void(const Result<Known>&)>;

  // `epoch` changes when the memory is lost. `boot_offset` plus the time since the machine's boot gives a clock that
  // nobody sets, and that continues after a reboot. `before`: requests of earlier runs.
  RequestMemory(MemoryBounds bounds, std::string epoch, Duration boot_offset, RequestsOnFile before = {});

  // Begins a request; its identity, id, digest, device and moves must be set. Returns the change to write. Returns
  // nullopt if a request with this id came before: `known` is then called, at once or when the result of the first
  // request is known.
  // Fails with request_id_reused if the first request had another digest.
  // Fails with request_memory_lost if the request may have come before and be forgotten: a request was forgotten since
  // `mark` was made. An empty `mark` is not checked.
  Result<std::optional<RequestChange>> begin(RememberedRequest request, std::string_view mark, TimePoint now,
                                             OnKnown known);
  // Records that the request has acted, and calls the waiting callbacks with its motion or its answer. Do not call it
  // for a motion without a written line.
  void acted(const Key& key);
  // Record that the request's motion was created, or has ended. Each returns the change to write; nullopt if no such
  // request is open.
  std::optional<RequestChange> made(const Key& key, std::uint64_t motion, std::string answer);
  std::optional<RequestChange> motion_ended(const Key& key, std::uint64_t motion, std::string answer);
  // Records the end of a request that is not a motion. Returns the change to write; nullopt if no such request is open.
  std::optional<RequestChange> ended(const Key& key, std::string answer);
  // Records that the request did nothing: waiting callers are refused with `why`, and the id is free again. Returns the
  // change to write; nullopt if the request has ended and so has done something.
  std::optional<RequestChange> refused(const Key& key, const Problem& why);

  // Returns the present state of the memory as "EPOCH-NUMBER".
  std::string mark() const;
  // Returns the requests that have not ended.
  std::vector<RememberedRequest> open() const;

 private:
  struct Remembered {
    RememberedRequest request;
    bool acted = false;
    std::vector<OnKnown> waiting;
  };
  using Requests = std::map<Key, Remembered>;

  Result<void> check_mark(std::string_view mark) const;
  std::int64_t forget_old(Duration lived);
  static Known known_of(const RememberedRequest& request) {
    return {request.device, request.motion, request.open, request.answer};
  }
  Remembered* find_open(const Key& key);
  static RequestChange ended(Remembered& remembered, std::string answer);

  const MemoryBounds bounds_;
  const std::string epoch_;
  const Duration boot_offset_;
  mutable std::mutex mutex_;
  Requests requests_;
  std::map<std::int64_t, Key> by_number_;
  std::int64_t last_ = 0, forgotten_ = 0;  // numbers of requests
};

}  // namespace axisgate::server::journal
