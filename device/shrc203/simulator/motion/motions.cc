#include "device/shrc203/simulator/motion/motions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "device/shrc203/simulator/motion/arcs.h"

namespace axisgate::shrc203::simulator {

void Motions::power_on() {
  execution_.clear();
  prebuffer_.clear();
  migrated_.clear();
  runs_.clear();
  completions_.clear();
  wait_tenths = 0;
}

// --- state -----------------------------------------------------------------------------------------------------------

Motions::Run* Motions::run_of(int number) {
  for (Run& run : runs_) {
    if (run.setting.axes.has(number)) return &run;
  }
  return nullptr;
}

bool Motions::operating(int number) const {
  const auto uses = [number](const auto& item) { return item.axes.has(number); };
  return std::any_of(runs_.begin(), runs_.end(), [&](const Run& run) { return uses(run.setting); }) ||
         std::any_of(migrated_.settings().begin(), migrated_.settings().end(), uses);
}

bool Motions::any_operating(const Axes& axes) const {
  const auto list = axes.list();
  return std::any_of(list.begin(), list.end(), [this](int number) { return operating(number); });
}

// An axis that has arrived is BUSY as well while its next segment waits for another axis.
bool Motions::busy(int number) const {
  if (axis(number).phase() != Axis::Phase::idle || operating(number)) return true;
  const auto& next = prebuffer_.settings();
  return std::any_of(next.begin(), next.end(), [&](const Setting& setting) {
    return setting.chains && setting.axes.has(number) && any_operating(setting.axes);
  });
}

bool Motions::busy(const Axes& axes) const {
  const auto list = axes.list();
  return std::any_of(list.begin(), list.end(), [this](int number) { return busy(number); });
}

bool Motions::returning(int number, Kind kind) const {
  return std::any_of(runs_.begin(), runs_.end(),
                     [&](const Run& run) { return run.setting.kind == kind && run.setting.axes.has(number); });
}

bool Motions::jogging(const Axes& axes) const {
  const auto list = axes.list();
  return std::all_of(list.begin(), list.end(), [this](int number) {
    return axis(number).phase() == Axis::Phase::moving &&
           std::any_of(runs_.begin(), runs_.end(), [number](const Run& run) {
             return run.setting.kind == Kind::jog && run.setting.axes.has(number) && !run.stopped.has(number);
           });
  });
}

const Setting* Motions::execution(Kind kind, int number) const {
  if (const Setting* set = execution_.find(kind, number)) return set;
  for (const Run& run : runs_) {
    if (run.setting.kind == kind && run.setting.axes.has(number)) return &run.setting;
  }
  return migrated_.find(kind, number);
}

const Setting* Motions::execution(Kind kind) const {
  for (const int number : kAxisNumbers) {
    if (const Setting* set = execution(kind, number)) return set;
  }
  return nullptr;
}

std::optional<TimePoint> Motions::next_event() const {
  std::optional<TimePoint> next;
  for (const Axis& candidate : axes_) {
    const auto event = candidate.next_event();
    if (event && (!next || *event < *next)) next = event;
  }
  return next;
}

std::vector<int> Motions::take_completions() { return std::exchange(completions_, {}); }

// --- setting ---------------------------------------------------------------------------------------------------------

void Motions::set_execution(Setting setting) {
  if (setting.indivisible()) {
    execution_.put(std::move(setting));
    return;
  }
  for (const int number : setting.axes.list()) execution_.put(setting.only(number));
}

void Motions::delete_execution(const Axes& axes) {
  std::vector<Setting> jogs;
  if (is("jog_survives_gc", "yes")) {
    std::copy_if(execution_.settings().begin(), execution_.settings().end(), std::back_inserter(jogs),
                 [](const Setting& setting) { return setting.kind == Kind::jog; });
  }
  execution_.disconnect(axes);
  for (Setting& jog : jogs) execution_.put(std::move(jog));
}

bool Motions::on_double_buffer(const Axes& axes) const {
  const auto counts = [&](const Setting& setting) { return setting.is_prebuffer && setting.axes.touches(axes); };
  return std::any_of(runs_.begin(), runs_.end(), [&](const Run& run) { return counts(run.setting); }) ||
         std::any_of(migrated_.settings().begin(), migrated_.settings().end(), counts);
}

// Reports whether an axis slows down after a stop; its operation then has no successor.
bool Motions::stopping(const Axes& axes) const {
  return std::any_of(runs_.begin(), runs_.end(), [&](const Run& run) { return run.stopped.touches(axes); });
}

// Returns whether a prebuffer setting that arrives now will start without a G.
Motions::Accepted Motions::acceptance(const Axes& axes) const {
  if (any_operating(axes)) {
    if (stopping(axes) && !is("stop_keeps_prebuffer", "starts_next")) return Accepted::waits_for_go;
    const bool chains = on_double_buffer(axes) || is("prebuffer_under_plain_move", "chains");
    return chains ? Accepted::chained : Accepted::waits_for_go;
  }
  if (!any_operating({1, 2, 3}) || is("prebuffer_while_other_axis_runs", "waits_for_go")) return Accepted::waits_for_go;
  return is("prebuffer_while_other_axis_runs", "chains") ? Accepted::chained : Accepted::no;
}

Motions::Accepted Motions::set_prebuffer(const Setting& setting) {
  const bool one_for_all = is("prebuffer_scope", "controller");
  const bool together = setting.indivisible() || one_for_all || is("chain_step_on", "all_axes_done");
  std::vector<Setting> parts;
  if (together) {
    parts.push_back(setting);
  } else {
    for (const int number : setting.axes.list()) parts.push_back(setting.only(number));
  }
  Accepted answer = Accepted::waits_for_go;
  for (Setting& part : parts) {
    const Accepted accepted = acceptance(part.axes);
    if (accepted == Accepted::no) return Accepted::no;
    if (accepted == Accepted::chained) answer = Accepted::chained;
    part.chains = accepted == Accepted::chained;
    part.is_prebuffer = true;
  }
  if (one_for_all) prebuffer_.clear();
  for (Setting& part : parts) prebuffer_.put(std::move(part));
  return answer;
}

// --- starting --------------------------------------------------------------------------------------------------------

bool Motions::can_start(const Axes& axes) const {
  bool any = false;
  for (const Buffer* buffer : {&execution_, &prebuffer_}) {
    for (const Setting& setting : buffer->settings()) {
      if (!setting.axes.touches(axes)) continue;
      if (setting.indivisible() && !setting.axes.within(axes)) return false;
      any = true;
    }
  }
  return any;
}

bool Motions::go(const Axes& axes, TimePoint now) {
  if (!can_start(axes)) return false;
  execution_.split(axes);
  prebuffer_.split(axes);
  auto& set = execution_.settings();
  const auto overlaps = [&](const Setting& next) {
    return next.axes.touches(axes) &&
           std::any_of(set.begin(), set.end(), [&](const Setting& setting) { return setting.axes.touches(next.axes); });
  };
  std::vector<Setting> waiting = prebuffer_.settings();
  const bool both = std::any_of(waiting.begin(), waiting.end(), overlaps);
  if (both && is("go_with_both_buffers", "ng")) return false;
  const bool execution_first = both && is("go_with_both_buffers", "execution_first");
  for (Setting& next : waiting) {
    if (!next.axes.touches(axes)) continue;
    prebuffer_.disconnect(next.axes);
    if (execution_first && overlaps(next)) {
      next.chains = true;
      prebuffer_.put(std::move(next));
    } else {
      execution_.put(std::move(next));
    }
  }
  const auto starting = std::stable_partition(set.begin(), set.end(),
                                              [&](const Setting& setting) { return !setting.axes.touches(axes); });
  for (auto next = starting; next != set.end(); ++next) migrated_.put(std::move(*next));
  set.erase(starting, set.end());
  start_migrated(now);
  return true;
}

void Motions::start_return(Kind kind, const Axes& axes, bool reports, TimePoint now) {
  Setting setting;
  setting.kind = kind;
  setting.axes = axes;
  start_each(setting, reports, now);
}

void Motions::start_each(const Setting& setting, bool reports, TimePoint now) {
  for (const int number : setting.axes.list()) {
    const Setting part = setting.only(number);
    runs_.push_back({part, reports, part.axes, {}});
    start_axis(part, number, now);
  }
}

void Motions::migrate() {
  auto& waiting = prebuffer_.settings();
  const auto staying = std::stable_partition(waiting.begin(), waiting.end(), [this](const Setting& setting) {
    return !setting.chains || any_operating(setting.axes);
  });
  for (auto next = staying; next != waiting.end(); ++next) migrated_.put(std::move(*next));
  waiting.erase(staying, waiting.end());
}

void Motions::start_migrated(TimePoint now) {
  const auto is_ready = [this](const Setting& setting) {
    const auto list = setting.axes.list();
    return std::all_of(list.begin(), list.end(), [this](int n) { return axis(n).phase() == Axis::Phase::idle; });
  };
  auto& waiting = migrated_.settings();
  for (auto next = std::find_if(waiting.begin(), waiting.end(), is_ready); next != waiting.end();
       next = std::find_if(waiting.begin(), waiting.end(), is_ready)) {
    const Setting setting = std::move(*next);
    waiting.erase(next);
    start(setting, now);
  }
}

void Motions::start(const Setting& setting, TimePoint now) {
  for (const int number : setting.axes.list()) {
    if (const auto& speed = setting.speeds[index_of(number)]) axis(number).speed = *speed;
  }
  const bool waits = setting.kind == Kind::wait_time || setting.kind == Kind::wait_input;
  const bool reports = setting.is_prebuffer && (!waits || is("wait_completion", "sent"));
  runs_.push_back({setting, reports, setting.axes, {}});
  if (setting.kind == Kind::line) {
    start_line(setting, now);
    return;
  }
  if (setting.kind == Kind::arc) {
    start_arc(setting, now);
    return;
  }
  for (const int number : setting.axes.list()) start_axis(setting, number, now);
}

// Manual 53) says that BEC: cancels a limit error; it does not say that nothing else does.
void Motions::forget_limit(int number) {
  if (is("limit_error_until", "next_start")) axis(number).limit_error = false;
}

void Motions::start_axis(const Setting& setting, int number, TimePoint now) {
  Axis& moved = axis(number);
  const std::int64_t value = setting.values[index_of(number)];
  forget_limit(number);
  switch (setting.kind) {
    case Kind::relative:
      moved.move(value, now);
      break;
    case Kind::absolute:
    case Kind::saved_position:
      moved.move(value - moved.coordinate(now), now);
      break;
    case Kind::logical_return:
      moved.move(-moved.coordinate(now), now);
      break;
    case Kind::origin_return:
      moved.return_to_origin(now);
      break;
    case Kind::jog:
      moved.jog(value < 0 ? -1 : 1, now);
      break;
    case Kind::wait_time:
      moved.wait(now + std::chrono::milliseconds(100) * value);
      break;
    case Kind::wait_input:
      moved.wait(value == inputs_ ? std::optional(now) : std::nullopt);
      break;
    case Kind::line:
    case Kind::arc:
      break;
  }
  if (moved.stepped()) ++starts_[index_of(number)];
}

// A jog may be slower than S, but F must not be (manual 89)).
void Motions::override_jog(int number, std::int64_t to_speed, TimePoint now) {
  Axis& driven = axis(number);
  driven.change_jog(to_speed, now);
  if (is("jog_override_afterwards", "forgotten")) return;
  Speed left_behind = driven.speed;
  left_behind.maximum = std::max(to_speed, driven.speed.minimum);
  run_of(number)->setting.speeds[index_of(number)] = left_behind;
}

// Manual 83), 84): the composite speed is S of the axis with the smallest number.
void Motions::start_line(const Setting& setting, TimePoint now) {
  double square = 0;
  for (const int number : setting.axes.list()) {
    const auto amount = static_cast<double>(setting.values[index_of(number)]);
    square += amount * amount;
  }
  const auto speed = static_cast<double>(axis(setting.axes.lowest()).speed.minimum);
  const MotionProfile path = MotionProfile::constant(std::sqrt(square), speed);
  for (const int number : setting.axes.list()) {
    const std::int64_t amount = setting.values[index_of(number)];
    forget_limit(number);
    axis(number).follow(amount, path, now);
    if (amount != 0) ++starts_[index_of(number)];
  }
}

// Manual 71), 77): starts an arc as a line is started; the axes of the circle come first, in order.
void Motions::start_arc(const Setting& setting, TimePoint now) {
  const ArcPath arc = path_of(*setting.arc);
  const auto speed = static_cast<double>(axis(setting.axes.lowest()).speed.minimum);
  const MotionProfile path = MotionProfile::constant(arc.length, speed);
  const auto numbers = setting.axes.list();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    Axis& moved = axis(numbers[i]);
    forget_limit(numbers[i]);
    const bool in_plane = i < arc.plane.size();
    if (in_plane) {
      moved.follow(arc.plane[i], path, now);
    } else {
      moved.follow(arc.linear, path, now);
    }
    if (in_plane ? arc.plane[i].radius > 0 : arc.linear != 0) ++starts_[index_of(numbers[i])];
  }
}

}  // namespace axisgate::shrc203::simulator
