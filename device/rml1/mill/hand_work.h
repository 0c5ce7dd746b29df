// Acts by hand: when a person may operate the mill, and for how long the mill may still move after that.
#pragma once

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/mill/by_hand.h"
#include "device/rml1/sending/abort.h"

namespace axisgate::rml1 {

// Not thread safe.
class HandWork {
 public:
  // The referenced objects must outlive this one. `slack`: factor by which a mill may be slower than the slowest mill
  // of its profile.
  HandWork(const Profile& profile, double slack, FlowLink& line, const Abort& abort)
      : profile_(profile), slack_(slack), line_(line), abort_(abort) {}

  // Returns the commands for an act. Fails as words_of() does.
  Result<HandCommands> words(const jobs::HandAct& act) const { return words_of(act, profile_, slack_); }
  // Fails with axis_busy if the mill takes no bytes. A step also fails if the mill may still execute an earlier act. A
  // step, and Z0 at the tool's height, also fail if the tool may still rise after an abort.
  Result<void> check(const jobs::HandAct& act, TimePoint now) const;
  // Fails with axis_busy if the mill has not taken all bytes sent before, or may still execute an act by hand.
  Result<void> check_idle(TimePoint now) const;
  // Writes the commands. Returns the longest time until the mill has executed this act and all acts before it.
  Duration write(const HandCommands& words, TimePoint now);

 private:
  Result<void> check_taken() const;
  Result<void> check_still(TimePoint now) const;
  Result<void> check_risen(TimePoint now) const;
  TimePoint done_by() const;

  const Profile& profile_;
  const double slack_;
  FlowLink& line_;
  const Abort& abort_;
  TimePoint written_at_{};  // time of the latest act by hand
  TimePoint done_at_{};     // latest end of all acts by hand, unless an abort ends them
};

}  // namespace axisgate::rml1
