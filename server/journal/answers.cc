#include "server/journal/answers.h"

#include <nlohmann/json.hpp>

#include "server/events/wall_time.h"
#include "server/journal/body.h"
#include "server/journal/motion_json.h"

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;
using std::chrono::microseconds;

// Converts a time to microseconds since 1970, because only calendar time is valid after a reboot. 0: never.
std::int64_t time_of(TimePoint time) {
  return std::chrono::duration_cast<microseconds>(to_wall(time).time_since_epoch()).count();
}

TimePoint time_in(const Json& json, const char* key) {
  const std::int64_t micros = json.at(key);
  return micros == 0 ? TimePoint{} : to_monotonic(WallTime(microseconds(micros)));
}

Json with_times(const stage::Motion& motion) {
  Json json = json_of(motion);
  json["created"] = time_of(motion.created);
  json["started"] = time_of(motion.started);
  json["ended"] = time_of(motion.ended);
  return json;
}

stage::Motion motion_with_times(const Json& json) {
  stage::Motion motion = motion_of(json);
  motion.created = time_in(json, "created");
  motion.started = time_in(json, "started");
  motion.ended = time_in(json, "ended");
  return motion;
}

Json event_json(const stage::ExecuteEvent& event) {
  Json json{{"kind", static_cast<int>(event.kind)},
            {"line", event.line},
            {"answer", event.answer},
            {"sent", event.sent},
            {"axis", event.axis},
            {"motion", event.motion},
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
                            .motion = json.value("motion", stage::MotionId{}),
                            .problem = {}};
  if (json.contains("problem")) event.problem = problem_of(json.at("problem"));
  return event;
}

std::vector<stage::ExecuteEvent> events_of(const Json& json) {
  std::vector<stage::ExecuteEvent> events;
  for (const Json& event : json) events.push_back(event_of(event));
  return events;
}

std::vector<std::uint64_t> numbers_of(const Json& json) { return json.get<std::vector<std::uint64_t>>(); }

// Returns the named part of an answer, or nullopt if the part is absent or malformed: anybody with write access to the
// file could have changed it.
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

std::string answer_of(const stage::Motion& motion) { return json_text({{"motion", with_times(motion)}}); }

std::string answer_of(const Problem& problem) { return json_text({{"problem", json_of(problem)}}); }

std::string answer_of(const std::vector<stage::ExecuteEvent>& events) {
  Json json{{"events", Json::array()}};
  for (const stage::ExecuteEvent& event : events) json["events"].push_back(event_json(event));
  return json_text(json);
}

std::string answer_of(const std::vector<std::uint64_t>& jobs) { return json_text({{"jobs", jobs}}); }

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
  return part<stage::Motion>(answer, "motion", motion_with_times);
}

std::vector<stage::ExecuteEvent> events_in(std::string_view answer) {
  return part<std::vector<stage::ExecuteEvent>>(answer, "events", events_of)
      .value_or(std::vector<stage::ExecuteEvent>());
}

std::vector<std::uint64_t> jobs_in(std::string_view answer) {
  return part<std::vector<std::uint64_t>>(answer, "jobs", numbers_of).value_or(std::vector<std::uint64_t>());
}

std::optional<Problem> problem_in(std::string_view answer) { return part<Problem>(answer, "problem", problem_of); }

}  // namespace axisgate::server::journal
