// Work by hand: when a person may do something besides jobs, and for how long the mill may still move after it.
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
  // The referenced objects must outlive this one. `slack`: by how much a mill may be slower than the slowest of its
  // profile.
  HandWork(const Profile& profile, double slack, FlowLink& line, const Abort& abort)
      : profile_(profile), slack_(slack), line_(line), abort_(abort) {}

  // Words of an act, as words_of() says and fails.
  Result<HandWords> words(const jobs::HandAct& act) const { return words_of(act, profile_, slack_); }
  // Fails with axis_busy if the mill takes nothing, or if the step or the abort before may not be done.
  Result<void> check(const jobs::HandAct& act, TimePoint now) const;
  // Fails with axis_busy if the mill has not taken all it was sent, or may still do what it was sent by hand.
  Result<void> check_idle(TimePoint now) const;
  // Writes the words. Returns the time after which the mill has done this, and all acts before, at the latest.
  Duration write(const HandWords& words, TimePoint now);
  // Notes that an abort ends what was sent by hand, and that the tool then rises.
  void abort_requested(TimePoint now);

 private:
  Result<void> check_taken() const;
  Result<void> check_still(TimePoint now) const;
  Result<void> check_risen(TimePoint now) const;

  const Profile& profile_;
  const double slack_;
  FlowLink& line_;
  const Abort& abort_;
  TimePoint done_at_{};   // what was sent by hand, at the latest
  TimePoint risen_at_{};  // the tool, after an abort that the mill obeys at once
};

}  // namespace axisgate::rml1
