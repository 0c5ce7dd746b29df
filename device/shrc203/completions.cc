#include "device/shrc203/completions.h"

namespace axisgate::shrc203 {

void Completions::connected() {
  for (Axis& axis : axes_) axis = {.possible = true, .arrived = false, .started = {}, .until = {}};
}

void Completions::started(AxisSet axes, TimePoint now) {
  for (const int number : axes.list()) axis(number) = {.possible = true, .arrived = false, .started = now, .until = {}};
}

void Completions::refused(AxisSet axes) {
  for (const int number : axes.list()) axis(number) = {};
}

void Completions::arrived(int axis_number) { axis(axis_number).arrived = true; }

AxisSet Completions::outstanding(TimePoint now) const {
  AxisSet set = possible(now);
  for (const int number : set.list()) {
    if (axis(number).arrived) set.remove(number);
  }
  return set;
}

void Completions::ready(AxisSet axes, TimePoint now) {
  for (const int number : axes.list()) {
    Axis& one = axis(number);
    const bool settled = !one.started || now - *one.started >= kStartSettles;
    if (one.possible && !one.until && settled) one.until = now + kAfterReady;
  }
}

void Completions::busy(AxisSet axes) {
  for (const int number : axes.list()) axis(number).until.reset();
}

AxisSet Completions::possible(TimePoint now) const {
  AxisSet set;
  for (const int number : AxisSet::all().list()) {
    const Axis& one = axis(number);
    if (one.possible && (!one.until || now < *one.until)) set.add(number);
  }
  return set;
}

std::optional<TimePoint> Completions::next_change(TimePoint now) const {
  std::optional<TimePoint> next;
  for (const Axis& one : axes_) {
    if (one.possible && one.until && *one.until > now && (!next || *one.until < *next)) next = one.until;
  }
  return next;
}

}  // namespace axisgate::shrc203
