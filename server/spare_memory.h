// Gives memory back to the system that a load has left unused: the allocator keeps it otherwise. The test of whether
// there is any costs next to nothing; giving back may hold up an allocation for some milliseconds, so it is done only
// where it is worth it.
#pragma once

#include <cstddef>
#include <functional>

#include "server/events/timeouts.h"

namespace axisgate::server {

class SpareMemory {
 public:
  static constexpr std::size_t kWorthIt = 4 << 20;  // bytes

  // What the allocator is asked.
  struct Allocator {
    std::function<std::size_t()> unused;  // bytes that it holds for nobody, given back or not
    std::function<void()> give_back;
  };
  explicit SpareMemory(Allocator allocator) : allocator_(std::move(allocator)) {}

  // To be called now and then.
  void look();

 private:
  Allocator allocator_;
  std::size_t given_back_ = 0;  // of what is unused now
};

// Looks every 20 s, on the thread of the time limits, as long as there are any. It outlives the call.
void keep_little_spare_memory(Timeouts& timeouts);

}  // namespace axisgate::server
