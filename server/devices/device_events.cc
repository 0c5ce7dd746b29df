#include "server/devices/device_events.h"

#include <fmt/ranges.h>

#include <chrono>
#include <utility>

#include "device/core/escape.h"
#include "device/core/explain.h"
#include "server/limits.h"
#include "server/log.h"

namespace axisgate::server {
namespace {

// Returns a text such as "move of axes 1 and 2". Settings and questions move no axes: "execute".
std::string named(const stage::Motion& motion) {
  if (motion.axes.empty()) return std::string(stage::name(motion.kind));
  return fmt::format("{} of {}", stage::name(motion.kind), to_string(motion.axes));
}

std::string because(const std::optional<Problem>& problem) {
  return problem ? fmt::format(": {} {}", name(problem->reason), explain(*problem)) : "";
}

// Returns a text such as ": axis 1 at 5000 pulses, axis 2 at 0 pulses"; empty if no position is known.
std::string places_text(const stage::Stop& stop) {
  std::string text;
  for (const auto& [axis, pulses] : stop.came_to) {
    text += fmt::format("{}axis {} at {} pulses", text.empty() ? ": " : ", ", axis, pulses);
  }
  return text;
}

}  // namespace

DeviceEvents::DeviceEvents(std::string device, EventBus& bus, StageMetrics& metrics, DeviceRecorder& recorder,
                           const Newest<stage::State>& newest_state, OnDue due, Keepers keepers)
    : device_(std::move(device)),
      bus_(bus),
      metrics_(metrics),
      recorder_(recorder),
      newest_state_(newest_state),
      due_(std::move(due)),
      keepers_(keepers) {}

void DeviceEvents::on_event(const stage::Event& event, TimePoint now) {
  metrics_.on_event(event);
  recorder_.on_event(event, now);
  if (keepers_.motions != nullptr) keepers_.motions->on_event(event);
  if (keepers_.stops != nullptr) keepers_.stops->on_event(event);
  if (const auto* stop = std::get_if<stage::StopRequested>(&event)) {
    for (const stage::StopRequested& reported : repeated_stops_.add(*stop, now)) keep_and_tell(reported, now);
    return;
  }
  for (const stage::StopRequested& count : repeated_stops_.ended(now)) keep_and_tell(count, now);
  if (!is_folded(event) && !is_known(event)) keep_and_tell(event, now);
}

void DeviceEvents::keep_and_tell(const stage::Event& event, TimePoint now) {
  if (keepers_.entries != nullptr) keepers_.entries->on_event(event, now);
  std::visit([&](const auto& what) { tell(what, now); }, event);
}

// Reports whether the event belongs to a folded stop: its lines or its end. Lines that repeat a late stop are folded,
// too; a blocked line has four of them a second.
bool DeviceEvents::is_folded(const stage::Event& event) const {
  if (const auto* written = std::get_if<stage::BytesWritten>(&event)) {
    return written->lane == Lane::stop && (repeated_stops_.folds(written->who) || !late_.empty());
  }
  if (const auto* ended = std::get_if<stage::ExchangeEnded>(&event)) {
    return ended->lane == Lane::stop && (repeated_stops_.folds(ended->who) || !late_.empty());
  }
  const auto* change = std::get_if<stage::StopChanged>(&event);
  if (change == nullptr || change->stop.late) return false;
  return std::ranges::all_of(change->stop.callers, [this](const auto& who) { return repeated_stops_.folds(who); });
}

// Reports whether the event only says that more callers wait for a stop that is known to be late.
bool DeviceEvents::is_known(const stage::Event& event) {
  const auto* change = std::get_if<stage::StopChanged>(&event);
  if (change == nullptr || !change->stop.late) return false;
  if (is_open(change->stop.state)) return !late_.insert(change->stop.id).second;
  late_.erase(change->stop.id);
  return false;
}

std::uint64_t DeviceEvents::motion_revision(stage::MotionId motion) const {
  const auto found = motions_.find(motion);
  return found == motions_.end() ? 0 : found->second.revision;
}

Moment DeviceEvents::motion_clock(stage::MotionId motion) const {
  const auto found = motions_.find(motion);
  return found == motions_.end() ? moment_of(monotonic_now()) : found->second.clock;
}

void DeviceEvents::tell(const stage::MotionChanged& change, TimePoint now) {
  const stage::Motion& motion = change.motion;
  Known& known = motions_.try_emplace(motion.id, Known{0, moment_of(now)}).first->second;
  known.revision = bus_.publish(device_, change, to_wall(now), known.clock);
  if (motions_.size() > kMotionsRemembered) motions_.erase(motions_.begin());
  if (motion.state == stage::MotionState::queued || motion.state == stage::MotionState::stopping) return;
  const bool well = motion.state == stage::MotionState::running || motion.state == stage::MotionState::succeeded;
  log::line(well ? log::Level::info : log::Level::warn, "{}: motion {} ({}, asked by {}) is {}{}", device_, motion.id,
            named(motion), escaped(motion.who), stage::name(motion.state), because(motion.problem));
}

void DeviceEvents::tell(const stage::LinkChanged& change, TimePoint now) {
  due_(Due::state);
  if (link_ && link_->link == change.link && link_->why == change.why) return;
  link_ = change;
  publish(change, now);
  const bool well = change.link == stage::LinkState::up || change.link == stage::LinkState::connecting;
  log::line(well ? log::Level::info : log::Level::warn, "{}: link is {}{}{}", device_, stage::name(change.link),
            change.why.empty() ? "" : ": ", change.why);
}

void DeviceEvents::tell(const stage::StopRequested& stop, TimePoint now) {
  publish(stop, now);
  log::warn("{}: {} of {} asked by {}{}", device_, stop.emergency ? "emergency stop" : "stop", to_string(stop.axes),
            escaped(stop.who), stop.count > 1 ? fmt::format(", {} times while nothing moved", stop.count) : "");
}

// Reports an open stop only if it is late: other stops are expected to be obeyed.
void DeviceEvents::tell(const stage::StopChanged& change, TimePoint now) {
  const stage::Stop& stop = change.stop;
  const bool open = is_open(stop.state);
  if (!open) due_(Due::state_at_once);
  if (open && !stop.late) return;
  publish(change, now);
  const std::string who = escaped(fmt::format("{}", fmt::join(stop.callers, ", ")));
  const auto seconds = [](Duration time) { return std::chrono::duration<double>(time).count(); };
  switch (stop.state) {
    case stage::StopState::asked:
    case stage::StopState::written:
      return log::warn("{}: the {} by {} stays open: nobody has seen the axes obey it, and it is repeated", device_,
                       title_of(stop), who);
    case stage::StopState::confirmed:
      return log::info("{}: the {} by {} is confirmed after {:.3f} s{}", device_, title_of(stop), who,
                       seconds(stop.ended - stop.asked), places_text(stop));
    case stage::StopState::replaced:
      return log::info("{}: the {} by {} is replaced by stop {}", device_, title_of(stop), who, stop.replaced_by);
    case stage::StopState::withdrawn:
      return log::warn("{}: the {} by {} was withdrawn by {}; nobody has seen the axes obey it", device_,
                       title_of(stop), who, escaped(stop.withdrawn_by));
  }
}

void DeviceEvents::tell(const stage::EmergencyLatchChanged& change, TimePoint now) {
  due_(Due::state_at_once);
  publish(change, now);
  if (change.latch) {
    log::warn("{}: latched by the emergency stop of {}: nothing moves until the errors of all axes are cleared",
              device_, escaped(change.who));
  } else {
    log::info("{}: the latch of the emergency stop was lifted by {}", device_, escaped(change.who));
  }
}

void DeviceEvents::tell(const stage::ForeignMotion& motion, TimePoint now) {
  publish(motion, now);
  log::warn("{}: FOREIGN_MOTION: {} moves, and nobody here requested it: the front panel, or a gateway before this one",
            device_, to_string(motion.axes));
}

void DeviceEvents::tell(const stage::ConditionChanged& change, TimePoint now) {
  bus_.publish(device_, change, to_wall(now), moment_of(now));
  log::line(change.begun ? log::Level::warn : log::Level::info, "{}: {}", device_,
            stage::words(change.condition, change.axes, change.begun, escaped(change.value)));
}

void DeviceEvents::tell(const stage::UnfinishedJudged& judged, TimePoint) {
  using What = stage::UnfinishedJudged::What;
  const std::string whose = fmt::format("{}: the daemon ended during {}", device_, judged.motions);
  switch (judged.what) {
    case What::not_ours:
      return log::warn(
          "{}; another controller answers now, or another program has used the line since: nothing is stopped, check "
          "{}",
          whose, to_string(judged.axes));
    case What::stopped:
      return log::warn("{}; stopping {}", whose, to_string(judged.axes));
    case What::finishes:
      return log::warn("{}; letting {} finish (at_exit)", whose, to_string(judged.axes));
    case What::stationary:
      return log::warn("{}; {} stationary now, outcome unknown: check the position", whose, to_string(judged.axes));
  }
}

void DeviceEvents::tell(const stage::SwitchesChanged& change, TimePoint now) {
  publish(change, now);
  for (const auto& one : change.changes) {
    log::warn("{}: memory switch {} of item {} is {} for good, and was {} (MS:, by {})", device_, one.number, one.item,
              escaped(one.after), escaped(one.before), escaped(change.who));
  }
  if (!change.unknown) return;
  log::warn("{}: memory switches may have changed permanently, and it is unknown which (MS:, by {}): compare them",
            device_, escaped(change.who));
}

void DeviceEvents::tell(const stage::ProgramNotice& notice, TimePoint now) {
  publish(notice, now);
  if (notice.kind == stage::ProgramNotice::Kind::ended) log::info("{}: a program has ended (COMP)", device_);
}

void DeviceEvents::tell(const stage::PathProgress& progress, TimePoint now) {
  publish(progress, now);
  if (progress.step != stage::PathProgress::Step::underrun) return;
  log::warn("{}: motion {}: underrun before segment {}: the chain had ended, and the path continues from a standstill",
            device_, progress.motion, progress.segment);
}

void DeviceEvents::tell(const stage::BarrierEntered& barrier, TimePoint) {
  log::warn("{}: replies cannot be trusted until the barrier has passed: {}", device_, barrier.why);
}

void DeviceEvents::tell(const stage::UnexpectedLine& line, TimePoint now) {
  if (now < next_unexpected_line_) {
    ++unexpected_lines_unlogged_;
    return;
  }
  log::warn("{}: dropped a line that nothing waited for: \"{}\" ({} more since the last such message)", device_,
            escaped(line.text), unexpected_lines_unlogged_);
  next_unexpected_line_ = now + kUnexpectedLinePause;
  unexpected_lines_unlogged_ = 0;
}

void DeviceEvents::tell(const stage::IllegalTransition& fault, TimePoint) {
  log::error(
      "{}: INTERNAL: {} while the {} was {}, which is impossible; everything is stopped and the line is opened again. "
      "Please "
      "report it with the device's recording of this moment: axisctl record --device {}, axisctl support",
      device_, fault.event, fault.machine, fault.state, device_);
}

void DeviceEvents::publish(Fact fact, TimePoint now) { bus_.publish(device_, std::move(fact), to_wall(now)); }

}  // namespace axisgate::server
