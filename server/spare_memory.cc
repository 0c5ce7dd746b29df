#include "server/spare_memory.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "server/limits.h"

namespace axisgate::server {
namespace {

// Blocks of at least this size, such as the longest messages, come from the system and return to it at once. By
// default, the allocator raises this limit with each freed block, and freed messages leave holes in its memory.
constexpr int kOfTheSystem = 128 << 10;  // bytes

void look_later(Timeouts& timeouts, std::shared_ptr<SpareMemory> memory) {
  timeouts.after(kSpareMemoryPause, [&timeouts, memory = std::move(memory)] {
    memory->look();
    look_later(timeouts, memory);
  });
}

}  // namespace

// Memory that was given back and used again counts as not given back.
void SpareMemory::look() {
  const std::size_t unused = allocator_.unused();
  given_back_ = std::min(given_back_, unused);
  if (unused - given_back_ < kWorthIt) return;
  allocator_.give_back();
  given_back_ = allocator_.unused();
}

void keep_little_spare_memory(Timeouts& timeouts) {
  mallopt(M_MMAP_THRESHOLD, kOfTheSystem);
  look_later(timeouts, std::make_shared<SpareMemory>(SpareMemory::Allocator{
                           .unused = [] { return mallinfo2().fordblks; },
                           .give_back = [] { malloc_trim(0); },
                       }));
}

}  // namespace axisgate::server
