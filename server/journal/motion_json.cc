#include "server/journal/motion_json.h"

#include <optional>

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;

template <class Value>
void add(Json& json, const char* key, const std::optional<Value>& value) {
  if (value) json[key] = *value;
}

template <class Value>
std::optional<Value> find(const Json& json, const char* key) {
  return json.contains(key) ? std::optional(json.at(key).get<Value>()) : std::nullopt;
}

Json result_json(const stage::AxisResult& result) {
  Json json{{"axis", result.axis}, {"completion_seen", result.completion_seen}};
  add(json, "target", result.target_pulses);
  add(json, "command", result.command_pulses);
  return json;
}

stage::AxisResult result_of(const Json& json) {
  return {json.at("axis"), find<std::int64_t>(json, "target"), find<std::int64_t>(json, "command"),
          json.at("completion_seen")};
}

Json scan_json(const stage::ScanResult& scan) {
  Json json{{"from", scan.run_from}, {"to", scan.run_to}};
  add(json, "interval", scan.interval);
  add(json, "expected", scan.expected);
  add(json, "expected_in_range", scan.expected_in_range);
  add(json, "observed", scan.observed);
  return json;
}

stage::ScanResult scan_of(const Json& json) {
  return {json.at("from"),
          json.at("to"),
          find<std::int64_t>(json, "interval"),
          find<std::int64_t>(json, "expected"),
          find<std::int64_t>(json, "expected_in_range"),
          find<std::int64_t>(json, "observed")};
}

}  // namespace

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

Json json_of(const stage::Motion& motion) {
  Json json{{"id", motion.id},
            {"kind", static_cast<int>(motion.kind)},
            {"state", static_cast<int>(motion.state)},
            {"axes", motion.axes.list()},
            {"written", motion.written},
            {"who", motion.who},
            {"request_id", motion.request_id},
            {"segments_total", motion.segments_total},
            {"segments_done", motion.segments_done},
            {"underruns", motion.underruns},
            {"results", Json::array()}};
  for (const stage::AxisResult& result : motion.results) json["results"].push_back(result_json(result));
  if (motion.problem) json["problem"] = json_of(*motion.problem);
  if (motion.scan) json["scan"] = scan_json(*motion.scan);
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
  motion.segments_total = json.at("segments_total");
  motion.segments_done = json.at("segments_done");
  motion.underruns = json.at("underruns");
  return motion;
}

}  // namespace axisgate::server::journal
