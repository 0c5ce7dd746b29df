// How many streams may be open at once, over all callers and doors.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "device/core/problem.h"
#include "server/api/request_kinds.h"

namespace axisgate::api {

// Thread safe.
class Streams {
 public:
  static constexpr int kStreamsMax = 4096;
  // A path is held whole, up to tens of megabytes: fewer of them than of other streams.
  static constexpr int kPathsMax = 32;

  explicit Streams(int streams_max = kStreamsMax, int paths_max = kPathsMax)
      : streams_(streams_max), paths_(paths_max) {}

  // One open stream; gives its place back when the last copy is gone. May outlive the limit.
  using Place = std::shared_ptr<void>;

  // As the quota of the kind has it. queue_full where no place is left.
  Result<Place> take(RequestKind kind) { return (rule_of(kind).quota == Quota::path ? paths_ : streams_).take(); }

 private:
  class Limit {
   public:
    explicit Limit(int most) : open_(std::make_shared<std::atomic<int>>(0)), most_(most) {}

    Result<Place> take() {
      if (open_->fetch_add(1) >= most_) {
        open_->fetch_sub(1);
        return fail(Reason::queue_full, std::to_string(most_) + " streams are open, and no more are served",
                    "close streams that nobody reads");
      }
      return Place(nullptr, [open = open_](void*) { open->fetch_sub(1); });
    }

   private:
    std::shared_ptr<std::atomic<int>> open_;
    const int most_;
  };

  Limit streams_;
  Limit paths_;
};

}  // namespace axisgate::api
