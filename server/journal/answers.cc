#include "server/journal/answers.h"

#include <nlohmann/json.hpp>

#include "server/events/wall_time.h"
#include "server/journal/body.h"

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;
using std::chrono::microseconds;

template <class Value>
void add(Json& json, const char* key, const std::optional<Value>& value) {
  if (value) json[key] = *value;
}

template <class Value>
std::optional<Value> find(const Json& json, const char* key) {
  return json.contains(key) ? std::optional(json.at(key).get<Value>()) : std::nullopt;
}

Json json_of(const Problem& problem) {
  Json json{{"reason", static_cast<int>(problem.reason)},
            {"message", problem.message},
            {"hint", problem.hint},
            {"sent", problem.sent},
            {"wire_reply", problem.wire_reply}};
  add(json, "axis", problem.axis);
  return json;
}

Problem problem_of(const Json& json) {
  return {.reason = static_cast<Reason>(json.at("reason").get<int>()),
          .message = json.at("message"),
          .hint = json.at("hint"),
          .axis = find<int>(json, "axis"),
          .sent = json.at("sent"),
          .wire_reply = json.at("wire_reply")};
}

// Since 1970, as only the calendar outlives a boot; 0: never.
std::int64_t time_of(TimePoint time) {
  return std::chrono::duration_cast<microseconds>(to_wall(time).time_since_epoch()).count();
}

TimePoint time_in(const Json& json, const char* key) {
  const std::int64_t micros = json.at(key);
  return micros == 0 ? TimePoint{} : to_monotonic(WallTime(microseconds(micros)));
}

Json json_of(const stage::AxisResult& result) {
  Json json{{"axis", result.axis}, {"completion_seen", result.completion_seen}};
  add(json, "target", result.target_pulses);
  add(json, "command", result.command_pulses);
  return json;
}

stage::AxisResult result_of(const Json& json) {
  return {json.at("axis"), find<std::int64_t>(json, "target"), find<std::int64_t>(json, "command"),
          json.at("completion_seen")};
}

Json json_of(const stage::ScanResult& scan) {
  Json json{{"from", scan.run_from}, {"to", scan.run_to}};
  add(json, "expected", scan.expected);
  add(json, "expected_in_range", scan.expected_in_range);
  add(json, "observed", scan.observed);
  return json;
}

stage::ScanResult scan_of(const Json& json) {
  return {json.at("from"), json.at("to"), find<std::int64_t>(json, "expected"),
          find<std::int64_t>(json, "expected_in_range"), find<std::int64_t>(json, "observed")};
}

Json json_of(const stage::Motion& motion) {
  Json json{{"id", motion.id},
            {"kind", static_cast<int>(motion.kind)},
            {"state", static_cast<int>(motion.state)},
            {"axes", axes_of(motion.axes)},
            {"written", motion.written},
            {"who", motion.who},
            {"request_id", motion.request_id},
            {"created", time_of(motion.created)},
            {"started", time_of(motion.started)},
            {"ended", time_of(motion.ended)},
            {"segments_total", motion.segments_total},
            {"segments_done", motion.segments_done},
            {"underruns", motion.underruns},
            {"results", Json::array()}};
  for (const stage::AxisResult& result : motion.results) json["results"].push_back(json_of(result));
  if (motion.problem) json["problem"] = json_of(*motion.problem);
  if (motion.scan) json["scan"] = json_of(*motion.scan);
  return json;
}

stage::Motion motion_of(const Json& json) {
  stage::Motion motion;
  motion.id = json.at("id");
  motion.kind = static_cast<stage::MotionKind>(json.at("kind").get<int>());
  motion.state = static_cast<stage::MotionState>(json.at("state").get<int>());
  for (const int axis : json.at("axes")) motion.axes.add(axis);
  for (const Json& result : json.at("results")) motion.results.push_back(result_of(result));
  if (json.contains("problem")) motion.problem = problem_of(json.at("problem"));
  if (json.contains("scan")) motion.scan = scan_of(json.at("scan"));
  motion.written = json.at("written");
  motion.who = json.at("who");
  motion.request_id = json.at("request_id");
  motion.created = time_in(json, "created");
  motion.started = time_in(json, "started");
  motion.ended = time_in(json, "ended");
  motion.segments_total = json.at("segments_total");
  motion.segments_done = json.at("segments_done");
  motion.underruns = json.at("underruns");
  return motion;
}

Json json_of(const stage::ExecuteEvent& event) {
  Json json{{"kind", static_cast<int>(event.kind)},
            {"line", event.line},
            {"answer", event.answer},
            {"sent", event.sent},
            {"axis", event.axis},
            {"wire_reply", event.wire_reply}};
  if (event.problem) json["problem"] = json_of(*event.problem);
  return json;
}

stage::ExecuteEvent event_of(const Json& json) {
  stage::ExecuteEvent event{.kind = static_cast<stage::ExecuteEvent::Kind>(json.at("kind").get<int>()),
                            .line = json.at("line"),
                            .answer = json.at("answer"),
                            .sent = json.at("sent"),
                            .wire_reply = json.at("wire_reply"),
                            .axis = json.at("axis"),
                            .problem = {}};
  if (json.contains("problem")) event.problem = problem_of(json.at("problem"));
  return event;
}

std::vector<stage::ExecuteEvent> events_of(const Json& json) {
  std::vector<stage::ExecuteEvent> events;
  for (const Json& event : json) events.push_back(event_of(event));
  return events;
}

// Of the part of that name: who may write the file could have written anything.
template <class Value>
std::optional<Value> part(std::string_view answer, const char* name, Value (*of)(const Json&)) {
  try {
    const Json json = Json::parse(answer);
    return json.contains(name) ? std::optional(of(json.at(name))) : std::nullopt;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

std::string answer_of(const stage::Motion& motion) { return json_text(Json{{"motion", json_of(motion)}}); }

std::string answer_of(const Problem& problem) { return json_text(Json{{"problem", json_of(problem)}}); }

std::string answer_of(const std::vector<stage::ExecuteEvent>& events) {
  Json json{{"events", Json::array()}};
  for (const stage::ExecuteEvent& event : events) json["events"].push_back(json_of(event));
  return json_text(json);
}

std::string answer_done() { return "{}"; }

bool is_refusal(Reason reason) {
  switch (reason) {
    case Reason::stopped:
    case Reason::reply_timed_out:
    case Reason::line_fault:
    case Reason::device_refused:
    case Reason::device_error:
    case Reason::unexplained:
    case Reason::target_not_reached:
    case Reason::outcome_unknown:
    case Reason::completion_outstanding:
    case Reason::internal:
      return false;
    default:
      return true;
  }
}

std::optional<stage::Motion> motion_in(std::string_view answer) {
  return part<stage::Motion>(answer, "motion", motion_of);
}

std::vector<stage::ExecuteEvent> events_in(std::string_view answer) {
  return part<std::vector<stage::ExecuteEvent>>(answer, "events", events_of)
      .value_or(std::vector<stage::ExecuteEvent>());
}

std::optional<Problem> problem_in(std::string_view answer) { return part<Problem>(answer, "problem", problem_of); }

}  // namespace axisgate::server::journal
