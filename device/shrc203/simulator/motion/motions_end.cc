// The ends of motions: at the target, at a limit, or after a stop; and the operations that follow.
#include <algorithm>
#include <utility>

#include "device/shrc203/simulator/motion/motions.h"

namespace axisgate::shrc203::simulator {

void Motions::process(TimePoint now) {
  for (auto next = next_event(); next && *next <= now; next = next_event()) {
    const auto due = std::find_if(axes_.begin(), axes_.end(), [&](const Axis& a) { return a.next_event() == next; });
    handle_event(static_cast<int>(due - axes_.begin()) + 1, *next);
  }
}

void Motions::handle_event(int number, TimePoint now) {
  switch (axis(number).phase()) {
    case Axis::Phase::moving:
      pulses_ended(number, now);
      return;
    case Axis::Phase::settling:
    case Axis::Phase::waiting:
      axis(number).rest();
      finish(number, now);
      start_migrated(now);
      return;
    case Axis::Phase::idle:
      return;
  }
}

void Motions::pulses_ended(int number, TimePoint now) {
  Axis& arrived = axis(number);
  const auto end = arrived.end_leg(now);
  if (end == Axis::LegEnd::next_leg) return;
  Run* run = run_of(number);
  if (run != nullptr && end == Axis::LegEnd::limit) {
    Axes stopped{number};
    if (run->setting.indivisible()) stopped = run->setting.axes;
    apply_stop_to_prebuffer(stopped);
    run->stopped.add(number);
    for (const int other : stopped.list()) {
      if (other == number) continue;
      run->stopped.add(other);
      axis(other).halt(now);
    }
  }
  const bool was_stopped = run != nullptr && run->stopped.has(number);
  if (run != nullptr && run->setting.kind == Kind::origin_return && !was_stopped) arrived.set_mechanical_origin();
  const bool was_still = !arrived.stepped() && !was_stopped;
  const Duration settling = was_still ? Duration::zero() : kSettling;
  arrived.settle(now + settling + std::chrono::milliseconds(100) * wait_tenths);
  if (is("completion_before_settle", "yes")) finish(number, now);
}

// Ends this axis's part of its operation. Manual 2: the prebuffer migrates, then the completion is sent, then the next
// operation starts.
void Motions::finish(int number, TimePoint now) {
  const auto found = std::find_if(runs_.begin(), runs_.end(), [&](const Run& run) {
    return run.setting.axes.has(number) && run.unfinished.has(number);
  });
  if (found == runs_.end()) return;
  found->unfinished.remove(number);
  leave_jog(*found, number);
  const bool done = found->unfinished.empty();
  const Run run = *found;
  if (done) {
    runs_.erase(found);
    migrate();
  }
  complete(run, number, done);
  start_migrated(now);
}

// Manual 93): F of D: is overwritten at the end of the jog.
void Motions::leave_jog(const Run& run, int number) {
  if (run.setting.kind != Kind::jog) return;
  if (const auto& speed = run.setting.speeds[index_of(number)]) axis(number).speed = *speed;
}

void Motions::complete(const Run& run, int number, bool done) {
  if (!run.reports) return;
  if (run.stopped.has(number) && is("completion_after_stop", "none")) return;
  if (!run.setting.indivisible()) {
    completions_.push_back(number);
  } else if (done && is("interpolation_completion", "lowest_axis")) {
    completions_.push_back(run.setting.axes.lowest());
  } else if (done) {
    for (const int each : run.setting.axes.list()) completions_.push_back(each);
  }
}

void Motions::stop_run(Run& run, const Axes& axes, bool slowly, TimePoint now) {
  const Axes stopping = run.setting.indivisible() ? run.setting.axes : axes;
  for (const int number : stopping.list()) {
    if (!run.setting.axes.has(number)) continue;
    Axis& stopped = axis(number);
    if (stopped.phase() == Axis::Phase::waiting) {
      run.stopped.add(number);
      stopped.wait(now);
    } else if (stopped.phase() == Axis::Phase::moving) {
      run.stopped.add(number);
      if (slowly) {
        stopped.decelerate(now);
      } else {
        stopped.halt(now);
      }
    }
  }
}

// Affects the settings of stopped axes, and those that wait for other axes to end. A setting that has migrated already
// belongs to the stopped operation.
void Motions::apply_stop_to_prebuffer(const Axes& axes) {
  if (is("stop_keeps_prebuffer", "starts_next")) return;
  migrated_.disconnect(axes);
  auto& waiting = prebuffer_.settings();
  const auto waits_for_others = [&](const Setting& setting) { return setting.chains && !any_operating(setting.axes); };
  if (is("stop_keeps_prebuffer", "kept")) {
    for (Setting& setting : waiting) {
      if (setting.axes.touches(axes) || waits_for_others(setting)) setting.chains = false;
    }
  } else {
    std::erase_if(waiting, waits_for_others);
    prebuffer_.disconnect(axes);
  }
}

void Motions::stop(const Axes& axes, TimePoint now) {
  apply_stop_to_prebuffer(axes);
  for (Run& run : runs_) {
    if (run.setting.axes.touches(axes)) stop_run(run, axes, true, now);
  }
}

void Motions::lose_excitation(int number, TimePoint now) {
  axis(number).excited = false;
  error_stop(number, now);
}

void Motions::error_stop(int number, TimePoint now) {
  Run* run = run_of(number);
  if (run == nullptr) return;
  apply_stop_to_prebuffer({number});
  stop_run(*run, {number}, false, now);
}

void Motions::emergency_stop(TimePoint now) {
  for (Axis& stopped : axes_) {
    if (stopped.phase() == Axis::Phase::moving) stopped.halt(now);
    stopped.rest();
    stopped.emergency = true;
    if (!stopped.excited_in_emergency) stopped.excited = false;
  }
  for (const Run& run : runs_) {
    for (const int number : run.unfinished.list()) leave_jog(run, number);
  }
  runs_.clear();
  migrated_.clear();
  execution_.clear();
  prebuffer_.clear();
}

void Motions::release(const Axes& axes, TimePoint now) {
  for (const int number : axes.list()) {
    if (axis(number).phase() == Axis::Phase::settling) axis(number).settle(now);
  }
}

void Motions::end_wait(Kind kind, const Axes& axes, TimePoint now) {
  for (const int number : axes.list()) {
    const Run* run = run_of(number);
    const bool waits = run != nullptr && run->setting.kind == kind && axis(number).phase() == Axis::Phase::waiting;
    if (waits) axis(number).wait(now);
  }
}

void Motions::inputs_are(int pattern, TimePoint now) {
  inputs_ = pattern;
  for (const Run& run : runs_) {
    if (run.setting.kind != Kind::wait_input) continue;
    for (const int number : run.setting.axes.list()) {
      if (axis(number).phase() == Axis::Phase::waiting && run.setting.values[index_of(number)] == pattern) {
        axis(number).wait(now);
      }
    }
  }
}

}  // namespace axisgate::shrc203::simulator
