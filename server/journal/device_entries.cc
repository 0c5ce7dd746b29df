#include "server/journal/device_entries.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "server/access/access.h"
#include "server/journal/answers.h"

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;

Json axes_of(stage::AxisSet axes) {
  Json list = Json::array();
  for (const int axis : axes.list()) list.push_back(axis);
  return list;
}

// Messages may name persons, so the journal has the reason alone.
Json results_of(const stage::Motion& motion) {
  Json results = Json::array();
  for (const stage::AxisResult& one : motion.results) {
    Json result{{"axis", one.axis}};
    if (one.target_pulses) result["target_pulses"] = *one.target_pulses;
    if (one.command_pulses) result["command_pulses"] = *one.command_pulses;
    results.push_back(std::move(result));
  }
  return results;
}

EntryKind kind_of(const stage::Motion& motion) {
  if (stage::is_outcome(motion.state)) return EntryKind::motion_ended;
  return motion.state == stage::MotionState::running ? EntryKind::motion_started : EntryKind::motion_requested;
}

Json body_of(const stage::Motion& motion) {
  Json body{{"kind", name(motion.kind)}, {"axes", axes_of(motion.axes)}};
  if (!motion.request_id.empty()) body["request_id"] = motion.request_id;
  if (!stage::is_outcome(motion.state)) return body;
  body["outcome"] = name(motion.state);
  body["results"] = results_of(motion);
  if (motion.problem) body["reason"] = name(motion.problem->reason);
  if (motion.segments_total > 0) body["segments_done"] = motion.segments_done;
  return body;
}

struct Said {
  EntryKind kind;
  Json body;
  std::string who{};
  std::uint64_t motion = 0;
};

std::optional<Said> said(const stage::MotionChanged& change) {
  const stage::Motion& motion = change.motion;
  if (motion.state == stage::MotionState::stopping) return std::nullopt;
  return Said{kind_of(motion), body_of(motion), motion.who, motion.id};
}

std::optional<Said> said(const stage::StopRequested& stop) {
  return Said{EntryKind::stop_requested, {{"axes", axes_of(stop.axes)}, {"emergency", stop.emergency}}, stop.who};
}

std::optional<Said> said(const stage::LinkChanged& change) {
  Json body{{"link", name(change.link)}, {"why", change.why}};
  if (!change.serial_number.empty()) body["serial_number"] = change.serial_number;
  return Said{EntryKind::link_changed, std::move(body)};
}

std::optional<Said> said(const stage::BarrierEntered& barrier) {
  return Said{EntryKind::barrier_entered, {{"why", barrier.why}}};
}

std::optional<Said> said(const stage::ForeignMotion& motion) {
  return Said{EntryKind::foreign_motion, {{"axes", axes_of(motion.axes)}}};
}

std::optional<Said> said(const stage::SwitchesChanged& change) {
  Json changes = Json::array();
  for (const auto& one : change.changes) {
    changes.push_back({{"item", one.item}, {"number", one.number}, {"before", one.before}, {"after", one.after}});
  }
  return Said{EntryKind::switches_changed, {{"changes", std::move(changes)}, {"unknown", change.unknown}}, change.who};
}

template <class Other>
std::optional<Said> said(const Other&) {
  return std::nullopt;
}

}  // namespace

// A motion of which no line was written is refused where its start is answered.
std::optional<RequestChange> DeviceEntries::change_of(const stage::Event& event) {
  const auto* change = std::get_if<stage::MotionChanged>(&event);
  if (change == nullptr || change->motion.request_id.empty()) return std::nullopt;
  const stage::Motion& motion = change->motion;
  const RequestMemory::Key key{identity_of(motion.who), motion.request_id};
  if (motion.state == stage::MotionState::queued) return requests_.made(key, motion.id, answer_of(motion));
  if (!stage::is_outcome(motion.state) || !motion.written) return std::nullopt;
  return requests_.motion_ended(key, motion.id, answer_of(motion));
}

void DeviceEntries::on_event(const stage::Event& event, TimePoint now) {
  const std::optional<RequestChange> change = change_of(event);
  if (journal_ == nullptr) return;
  auto noted = std::visit([](const auto& what) { return said(what); }, event);
  if (!noted) return;
  journal_->append({{.kind = noted->kind,
                     .time = to_wall(now),
                     .boot_time = now,
                     .device = device_,
                     .who = std::move(noted->who),
                     .motion = noted->motion,
                     // What came from a device may be no UTF-8.
                     .body = noted->body.dump(-1, ' ', false, Json::error_handler_t::replace)},
                    change.value_or(RequestChange{})});
}

}  // namespace axisgate::server::journal
