// Which axis numbers may come over the line by themselves, and until when. Design: a notice is never taken for a reply.
#pragma once

#include <array>
#include <optional>

#include "device/core/time.h"
#include "device/shrc203/command/axes.h"

namespace axisgate::shrc203 {

class Completions {
 public:
  // After a connect nobody knows what was left running: every axis may complete.
  void connected();

  // The first byte of HRT:, ZRT: or a G after a prebuffer setting is about to be written.
  void started(AxisSet axes, TimePoint now);

  // A prebuffer setting for these axes was answered OK_D, or may have been: it begins by itself when what runs has
  // ended, even before its G.
  void chained(AxisSet axes, TimePoint now);

  // A completion was received: one for each start, more in a chain.
  void arrived(int axis);

  // A reading showed these axes as READY, or as busy. Returns those for which it changed anything. An axis that moves
  // may complete though nothing was started on it: the line may have turned a command for another axis into one for it.
  AxisSet ready(AxisSet axes, TimePoint now);
  AxisSet busy(AxisSet axes);

  // An exchange written at `written` was answered. The controller answers in order, so by then every number that it had
  // sent before has come; one whose time after READY has passed cannot come. Axes that the answer itself shows
  // as busy are excepted: something has started them since.
  void answered(TimePoint written, AxisSet busy = {});

  AxisSet possible() const;
  bool possible(int axis) const { return possible().has(axis); }

  // Axes of which a completion may still come and has not: nothing may start on them, or the late number of one motion
  // would look like the next one's.
  AxisSet outstanding() const;

  // From when on an exchange would settle the matter for all of `axes`; nothing while one of them may still be moving.
  std::optional<TimePoint> settles_from(AxisSet axes) const;

 private:
  struct Axis {
    bool possible = false;
    bool arrived = false;
    std::optional<TimePoint> started{};  // nothing: before the connect
    std::optional<TimePoint> until{};    // set by READY
  };
  Axis& axis(int number) { return axes_[static_cast<std::size_t>(number - 1)]; }
  const Axis& axis(int number) const { return axes_[static_cast<std::size_t>(number - 1)]; }

  std::array<Axis, kAxisCount> axes_;
};

}  // namespace axisgate::shrc203
