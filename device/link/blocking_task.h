// Runs work that may block, such as a query to a name server, outside of the strands.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "device/link/asio.h"

namespace axisgate {

// Runs `work` on its own thread and passes its result to `done` on the strand. A caller that releases the returned
// pointer cancels the wait: `done` is not called, and the thread ends when `work` does. Call this function and release
// the pointer on the strand, or while no thread runs its io_context. Release the pointer before the io_context ends.
template <class Value>
[[nodiscard]] std::shared_ptr<void> run_blocking_task(const Strand& strand, std::function<Value()> work,
                                                      std::function<void(Value)> done) {
  struct Waiting {
    std::mutex mutex;
    // Empty once nobody waits: a strand must not outlive its io_context, but this thread may.
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
