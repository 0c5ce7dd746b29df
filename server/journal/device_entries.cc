#include "server/journal/device_entries.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "server/access/access.h"
#include "server/journal/answers.h"
#include "server/journal/body.h"

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;

// Each line is [line, answer, microseconds since the motion's request], or [line, answer] without a motion.
Json lines_json(const std::vector<ExchangedLines::Line>& lines) {
  Json list = Json::array();
  for (const ExchangedLines::Line& line : lines) {
    Json one = Json::array({line.text, line.answer ? Json(*line.answer) : Json()});
    if (line.at) one.push_back(std::chrono::duration_cast<std::chrono::microseconds>(*line.at).count());
    list.push_back(std::move(one));
  }
  return list;
}

// Omits messages, which may name persons; the journal has the reason alone.
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

// Reports whether the request was refused: the refusal then has an entry. An Execute that wrote nothing counts as
// refused only for some reasons, since it need not move anything.
bool is_refused(const stage::Motion& motion) {
  if (motion.written) return false;
  return motion.kind != stage::MotionKind::execute || (motion.problem && is_refusal(motion.problem->reason));
}

Json body_of(const stage::Motion& motion) {
  Json body{{"kind", name(motion.kind)}, {"axes", axes_of(motion.axes)}};
  if (!motion.request_id.empty()) body["request_id"] = motion.request_id;
  if (!stage::is_outcome(motion.state)) return body;
  body["outcome"] = name(motion.state);
  body["results"] = results_of(motion);
  if (is_refused(motion)) body["refused"] = true;
  if (motion.problem) body["reason"] = name(motion.problem->reason);
  if (motion.segments_total > 0) body["segments_done"] = motion.segments_done;
  return body;
}

std::optional<Noted> said(const stage::MotionChanged& change) {
  const stage::Motion& motion = change.motion;
  if (motion.state == stage::MotionState::stopping) return std::nullopt;
  return Noted{kind_of(motion), body_of(motion), motion.who, motion.id};
}

std::optional<Noted> said(const stage::StopRequested& stop) {
  Json body{{"axes", axes_of(stop.axes)}, {"emergency", stop.emergency}};
  if (stop.count > 1) body["count"] = stop.count;
  return Noted{EntryKind::stop_requested, std::move(body), stop.who};
}

// Returns nullopt for a replaced stop, which ends together with its replacement.
std::optional<Noted> said(const stage::StopChanged& change) {
  const stage::Stop& stop = change.stop;
  if (is_open(stop.state) || stop.state == stage::StopState::replaced) return std::nullopt;
  Json body{{"stop", stop.id},
            {"axes", axes_of(stop.axes)},
            {"emergency", stop.kind == stage::StopKind::emergency},
            {"outcome", name(stop.state)},
            {"late", stop.late},
            {"after_ms", std::chrono::duration_cast<std::chrono::milliseconds>(stop.ended - stop.asked).count()}};
  for (const auto& [axis, pulses] : stop.came_to) {
    body["results"].push_back({{"axis", axis}, {"command_pulses", pulses}});
  }
  const std::string who = stop.callers.empty() ? "" : stop.callers.front();
  return Noted{EntryKind::stop_ended, std::move(body),
               stop.state == stage::StopState::withdrawn ? stop.withdrawn_by : who};
}

std::optional<Noted> said(const stage::EmergencyLatchChanged& change) {
  return Noted{change.latch ? EntryKind::emergency_latched : EntryKind::emergency_cleared, Json::object(), change.who};
}

std::optional<Noted> said(const stage::LinkChanged& change) {
  Json body{{"link", name(change.link)}, {"why", change.why}};
  if (!change.serial_number.empty()) body["serial_number"] = change.serial_number;
  return Noted{EntryKind::link_changed, std::move(body)};
}

std::optional<Noted> said(const stage::BarrierEntered& barrier) {
  return Noted{EntryKind::barrier_entered, {{"why", barrier.why}}};
}

std::optional<Noted> said(const stage::ForeignMotion& motion) {
  return Noted{EntryKind::foreign_motion, {{"axes", axes_of(motion.axes)}}};
}

std::int64_t micros(TimePoint time) {
  return std::chrono::floor<std::chrono::microseconds>(to_wall(time).time_since_epoch()).count();
}

// A condition of the whole controller has a value and no axes.
std::optional<Noted> said(const stage::ConditionChanged& change) {
  Json body{{"condition", name(change.condition)},
            {"axes", axes_of(change.axes)},
            {"begun", change.begun},
            {"seen_us", micros(change.seen)}};
  if (!change.value.empty()) body["value"] = change.value;
  if (change.before != TimePoint{}) body["before_us"] = micros(change.before);
  return Noted{EntryKind::condition_changed, std::move(body)};
}

std::optional<Noted> said(const stage::SwitchesChanged& change) {
  Json changes = Json::array();
  for (const auto& one : change.changes) {
    changes.push_back({{"item", one.item}, {"number", one.number}, {"before", one.before}, {"after", one.after}});
  }
  return Noted{EntryKind::switches_changed, {{"changes", std::move(changes)}, {"unknown", change.unknown}}, change.who};
}

template <class Other>
std::optional<Noted> said(const Other&) {
  return std::nullopt;
}

}  // namespace

std::vector<stage::AxisResult> results_in(std::string_view details) {
  const Json body = Json::parse(details, nullptr, false);
  std::vector<stage::AxisResult> results;
  if (!body.is_object() || !body.contains("results")) return results;
  for (const Json& one : body.at("results")) {
    stage::AxisResult result;
    result.axis = one.at("axis");
    if (one.contains("target_pulses")) result.target_pulses = one.at("target_pulses").get<std::int64_t>();
    if (one.contains("command_pulses")) result.command_pulses = one.at("command_pulses").get<std::int64_t>();
    results.push_back(result);
  }
  return results;
}

// Returns nullopt at the end of a motion of which no line was written: its request is refused when its start is
// answered.
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
  std::optional<RequestChange> change = change_of(event);
  if (journal_ == nullptr) return;
  if (const auto lines = lines_.on_event(event, now)) {
    Json body{{"axes", axes_of(lines->axes)}, {"lines", lines_json(lines->lines)}};
    const Noted apart{EntryKind::lines_exchanged, std::move(body), lines->who, lines->motion};
    journal_->append({entry_of(apart, device_, now)});
  }
  auto noted = std::visit([](const auto& what) { return said(what); }, event);
  if (!noted) return;
  if (noted->kind == EntryKind::motion_started || noted->kind == EntryKind::motion_ended) {
    const auto lines = lines_.take(std::get<stage::MotionChanged>(event).motion);
    if (!lines.empty()) noted->body["lines"] = lines_json(lines);
  }
  journal_->append({entry_of(*std::move(noted), device_, now), std::move(change).value_or(RequestChange{})});
}

}  // namespace axisgate::server::journal
