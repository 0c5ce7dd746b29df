// Completions that may still arrive from each axis, so that a notice is never taken for a reply.
#pragma once

#include <optional>
#include <vector>

#include "device/core/time.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

// Axes that the controller does not have are ignored: a recording may name them.
class Completions {
 public:
  explicit Completions(int axis_count) : axes_(static_cast<std::size_t>(axis_count)) {}

  // Makes a completion of every axis possible: after a connect it is unknown which axes still move.
  void connected();

  // Called right before the first byte of HRT:, ZRT: or of a G: after a prebuffer setting is written.
  void started(AxisSet axes, TimePoint now);

  // Called when a prebuffer setting for these axes was answered OK_D, or may have been. The setting starts by itself
  // when the running motion has ended, even before its G:.
  void chained(AxisSet axes, TimePoint now);

  // Called when a completion was received: one for each start, more in a chain.
  void arrived(int axis);

  // Called when a reading showed these axes as READY, or as busy. Returns the axes for which this changed anything. A
  // moving axis may complete even if nothing was started on it: the line may have turned a command for another axis
  // into a command for this one.
  AxisSet ready(AxisSet axes, TimePoint now);
  AxisSet busy(AxisSet axes);

  // Called when the exchange written at `written` was answered. The controller replies in order, so every number that
  // it sent earlier has arrived. A completion whose time limit after READY has passed by then is no longer possible.
  // Axes that the reply itself shows as busy are excepted: something has started them since.
  void answered(TimePoint written, AxisSet busy = {});

  AxisSet possible() const;
  bool possible(int axis) const { return possible().has(axis); }

  // Returns the axes whose completion is possible and has not arrived. Nothing may start on them: the late completion
  // of one motion would be taken for the completion of the next.
  AxisSet outstanding() const;

  // Returns the time from which an exchange settles the matter for all of `axes`. nullopt if one of them may still be
  // moving, or if none may complete.
  std::optional<TimePoint> settles_from(AxisSet axes) const;

 private:
  struct Axis {
    bool possible = false;
    bool arrived = false;
    std::optional<TimePoint> started{};  // nullopt if the start was not seen
    std::optional<TimePoint> until{};    // set by READY; end of the time in which a completion may arrive
  };
  Axis& axis(int number) { return axes_[static_cast<std::size_t>(number - 1)]; }
  const Axis& axis(int number) const { return axes_[static_cast<std::size_t>(number - 1)]; }

  AxisSet all() const { return AxisSet::first(static_cast<int>(axes_.size())); }

  std::vector<Axis> axes_;
};

}  // namespace axisgate::shot
