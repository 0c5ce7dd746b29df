// How many streams may be open at once, over all services: ours to refuse, since HTTP/2's own limit would make a Stop
// wait behind its caller's open calls.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "device/core/problem.h"

namespace axisgate::rpc {

// Thread safe.
class StreamLimit {
 public:
  static constexpr int kStreamsMax = 4096;

  explicit StreamLimit(int streams_max = kStreamsMax)
      : open_(std::make_shared<std::atomic<int>>(0)), max_(streams_max) {}

  // One open stream; gives its place back when the last copy is gone. May outlive the limit.
  using Place = std::shared_ptr<void>;

  // queue_full when there is none left.
  Result<Place> take() {
    if (open_->fetch_add(1) >= max_) {
      open_->fetch_sub(1);
      return fail(Reason::queue_full, std::to_string(max_) + " streams are open, and no more are served",
                  "close streams that nobody reads");
    }
    return Place(nullptr, [open = open_](void*) { open->fetch_sub(1); });
  }

 private:
  std::shared_ptr<std::atomic<int>> open_;
  const int max_;
};

}  // namespace axisgate::rpc
