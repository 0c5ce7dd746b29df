// How another thread gives work to a strand.
#pragma once

#include <functional>
#include <memory>

#include "device/link/asio.h"

namespace axisgate {

// Why not boost::asio::post: Asio wakes the other thread while it holds the lock that this thread needs first, so that
// most hand-overs put it to sleep a second time (README, Threads).
//
// Thread safe, except construction and close().
class Inbox {
 public:
  // Throws boost::system::system_error without a free descriptor.
  explicit Inbox(const Strand& strand);
  ~Inbox();
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  // Tasks run on the strand, in the order of posting. What else waits there has its turn between them. Of a task that
  // cannot run since this was closed, `too_late` is called, if there is one: by close(), or from within post().
  void post(std::function<void()> task, std::function<void()> too_late = {});
  // No task runs from now on. On the strand, or when no thread runs its io_context. Needed before the io_context ends.
  void close();

 private:
  class Queue;
  std::shared_ptr<Queue> queue_;
};

}  // namespace axisgate
