// Returns memory that the allocator keeps unused after a load to the system. The check is cheap, but giving memory back
// may delay an allocation for several milliseconds, so it happens only for a worthwhile amount.
#pragma once

#include <cstddef>
#include <functional>

#include "server/events/timeouts.h"

namespace axisgate::server {

class SpareMemory {
 public:
  static constexpr std::size_t kWorthIt = 4 << 20;  // bytes

  // Functions of the allocator.
  struct Allocator {
    std::function<std::size_t()> unused;  // unused bytes, including those already given back
    std::function<void()> give_back;
  };
  explicit SpareMemory(Allocator allocator) : allocator_(std::move(allocator)) {}

  // Checks for unused memory and gives it back. Call it periodically.
  void look();

 private:
  Allocator allocator_;
  std::size_t given_back_ = 0;  // part of the unused bytes
};

// Checks every 20 s on the thread of `timeouts`, which must outlive the call.
void keep_little_spare_memory(Timeouts& timeouts);

}  // namespace axisgate::server
