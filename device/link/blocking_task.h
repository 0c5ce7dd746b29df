// Work that may block, such as asking a name server, kept away from the strands.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "device/link/asio.h"

namespace axisgate {

// Runs `work` on a thread of its own and hands its result to `done` on the strand. A caller that releases the returned
// pointer does not wait any more: `done` is not called then, and the thread ends by itself when `work` does. Call it,
// and release the pointer, on the strand or when no thread runs its io_context. Release it before the io_context ends.
template <class Value>
[[nodiscard]] std::shared_ptr<void> run_blocking_task(const Strand& strand, std::function<Value()> work,
                                                      std::function<void(Value)> done) {
  struct Waiting {
    std::mutex mutex;
    // Emptied when nobody waits any more: a strand may not outlive its io_context, as this thread may.
    std::optional<Strand> strand;
    std::function<void(Value)> done;
  };
  auto waiting = std::make_shared<Waiting>();
  waiting->strand.emplace(strand);
  waiting->done = std::move(done);
  std::thread([waiting, work = std::move(work)] {
    Value value = work();
    const std::lock_guard lock(waiting->mutex);
    if (!waiting->strand) return;
    boost::asio::post(*waiting->strand, [waiting, value = std::move(value)]() mutable {
      if (const auto tell = std::exchange(waiting->done, {})) tell(std::move(value));
    });
  }).detach();
  return {waiting.get(), [waiting](void*) {
            const std::lock_guard lock(waiting->mutex);
            waiting->strand.reset();
            waiting->done = {};
          }};
}

}  // namespace axisgate
