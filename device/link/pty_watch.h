// Watches clients come and go at a pseudo terminal's other end, in order.
#pragma once

#include <cstdint>

#include "device/core/problem.h"
#include "device/link/descriptor.h"
#include "device/link/pty.h"

namespace axisgate {

// Counts clients by inotify. The master alone reports whether a client is there, but not that one client left and
// another came between two looks. The kernel merges equal events that follow each other, so the count is a guess with
// several clients at once: everybody_left() corrects it.
class PtyWatch {
 public:
  struct Visits {
    int came = 0;               // number of clients that came when none was there
    bool last_wrote = false;    // the last of these clients has written
    bool others_wrote = false;  // an earlier one of these clients has written

    void add(const Visits& later);
  };

  static Result<PtyWatch> open(const Pty& pty);

  int descriptor() const { return events_.get(); }  // readable when drain() has a change
  Visits drain();                                   // visits since the last call
  void everybody_left() { clients_ = 0; }

 private:
  explicit PtyWatch(Descriptor events) : events_(std::move(events)) {}
  void count(std::uint32_t event, Visits& visits);

  Descriptor events_;
  int clients_ = 0;
};

}  // namespace axisgate
