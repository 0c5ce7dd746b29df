// Queue through which other threads give work to a strand.
#pragma once

#include <functional>
#include <memory>

#include "device/link/asio.h"

namespace axisgate {

// An Inbox replaces boost::asio::post, which wakes the other thread while it has the lock that this thread needs first,
// so that most hand-overs put that thread to sleep a second time (README, Threads).
//
// Thread safe, except construction and close().
class Inbox {
 public:
  // Throws boost::system::system_error if no descriptor is free.
  explicit Inbox(const Strand& strand);
  ~Inbox();
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  // Runs a task on the strand, in the order of posting. Other work of the strand has its turn between tasks. If the
  // task cannot run because the inbox was closed, `too_late` is called, if given: by close(), or from within post().
  void post(std::function<void()> task, std::function<void()> too_late = {});
  // Drops all tasks; none runs after this call. Call it on the strand, or while no thread runs its io_context. Must be
  // called before the io_context ends.
  void close();

 private:
  class Queue;
  std::shared_ptr<Queue> queue_;
};

}  // namespace axisgate
