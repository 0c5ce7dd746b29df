#include "device/shot/line/completions.h"

#include "device/core/guard.h"
#include "device/shot/limits.h"

namespace axisgate::shot {

void Completions::connected() {
  for (Axis& axis : axes_) axis = {.possible = guarded(Guard::possible_after_connect)};
}

void Completions::started(AxisSet axes, TimePoint now) {
  for (const int number : (axes & all()).list()) axis(number) = {.possible = true, .started = now};
}

void Completions::chained(AxisSet axes, TimePoint now) {
  AxisSet changed;
  for (const int number : (axes & all()).list()) {
    if (!axis(number).possible || axis(number).until) changed.add(number);
  }
  if (guarded(Guard::possible_after_chained_setting)) started(changed, now);
}

void Completions::arrived(int axis_number) { axis(axis_number).arrived = true; }

AxisSet Completions::outstanding() const {
  AxisSet set = possible();
  for (const int number : set.list()) {
    if (axis(number).arrived) set.remove(number);
  }
  return set;
}

AxisSet Completions::ready(AxisSet axes, TimePoint now) {
  AxisSet changed;
  for (const int number : (axes & all()).list()) {
    Axis& one = axis(number);
    const bool settled = !guarded(Guard::start_settles) || !one.started || now - *one.started >= kReadyOutdatedMax;
    if (!one.possible || one.until || !settled) continue;
    one.until = guarded(Guard::possible_after_ready) ? now + kCompletionAfterReadyMax : now;
    changed.add(number);
  }
  return changed;
}

AxisSet Completions::busy(AxisSet axes) {
  AxisSet changed;
  for (const int number : (axes & all()).list()) {
    Axis& one = axis(number);
    const bool unasked = !one.possible && guarded(Guard::possible_when_seen_busy);
    if (unasked || one.until) changed.add(number);
    if (unasked) one = {.possible = true};
    one.until.reset();
  }
  return changed;
}

void Completions::answered(TimePoint written, AxisSet busy) {
  for (const int number : all().list()) {
    Axis& one = axis(number);
    if (busy.has(number)) continue;
    const bool after = one.until && (*one.until <= written || !guarded(Guard::settled_by_exchange));
    if (one.possible && after) one = {};
  }
}

AxisSet Completions::possible() const {
  AxisSet set;
  for (const int number : all().list()) {
    if (axis(number).possible) set.add(number);
  }
  return set;
}

std::optional<TimePoint> Completions::settles_from(AxisSet axes) const {
  std::optional<TimePoint> latest;
  for (const int number : (axes & all()).list()) {
    const Axis& one = axis(number);
    if (!one.possible) continue;
    if (!one.until) return {};
    if (!latest || *one.until > *latest) latest = one.until;
  }
  return latest;
}

}  // namespace axisgate::shot
