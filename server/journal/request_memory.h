// What became of requests, by the ids that their callers gave them: a request that comes again is answered, and does
// not act again.
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

// How long and how many are remembered. Of one that is forgotten a repeat would act again, so what a caller repeats
// without a person carries a mark: RequestMemory::mark().
struct MemoryBounds {
  Duration kept = std::chrono::hours(24);
  std::size_t most = 20'000;
};

// Thread safe. Callbacks are called from within the call that answers them.
class RequestMemory {
 public:
  using Key = std::pair<std::string, std::string>;  // identity and id

  // What is known of a request that came before.
  struct Known {
    std::string device;
    std::uint64_t motion = 0;  // 0: it has none
    bool open = false;         // it has not ended
    std::string answer;        // of an open motion: as it was made
  };
  using OnKnown = std::function<void(const Result<Known>&)>;

  // `epoch` is another text where all was forgotten. `boot_offset` added to the time since the machine's boot gives
  // a clock that nobody sets, and that continues over boots. `before` are those of the runs before.
  RequestMemory(MemoryBounds bounds, std::string epoch, Duration boot_offset, RequestsOnFile before = {});

  // Begins a request, of which identity, id, digest, device and moves are set. What is to be written of it; nothing:
  // one with its id came before, and `known` is called, now or once it is known what it became. request_id_reused,
  // where that one was another request; request_memory_lost, where it may have come and be forgotten: something was
  // forgotten since `mark` was made. Empty: no mark.
  Result<std::optional<RequestChange>> begin(RememberedRequest request, std::string_view mark, TimePoint now,
                                             OnKnown known);
  // It has acted: those who wait are answered, with its motion or what it answered. Of a motion without a written line:
  // nothing yet.
  void acted(const Key& key);
  // Its motion was made, or it has ended. What is to be written; nothing, where no such request is open.
  std::optional<RequestChange> made(const Key& key, std::uint64_t motion, std::string answer);
  std::optional<RequestChange> motion_ended(const Key& key, std::uint64_t motion, std::string answer);
  // One that is no motion has ended. Likewise.
  std::optional<RequestChange> ended(const Key& key, std::string answer);
  // It has done nothing: those who wait are refused likewise, and the id is free. What is to be written; nothing where
  // it has ended, so that it has done something.
  std::optional<RequestChange> refused(const Key& key, const Problem& why);

  // "EPOCH-NUMBER": where the memory is now.
  std::string mark() const;
  // Those without an end.
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
  std::int64_t last_ = 0, forgotten_ = 0;  // numbers
};

}  // namespace axisgate::server::journal
