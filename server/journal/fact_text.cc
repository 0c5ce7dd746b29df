#include "server/journal/fact_text.h"

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "server/journal/body.h"
#include "server/journal/motion_json.h"

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;
using std::chrono::nanoseconds;

// Writes a time unchanged: times in a fact are relative to the fact's own clock.
std::int64_t nanos_of(TimePoint time) { return time.time_since_epoch().count(); }
TimePoint time_of(const Json& json) { return TimePoint(nanoseconds(json.get<std::int64_t>())); }

stage::AxisSet axes_in(const Json& list) {
  stage::AxisSet axes;
  for (const int axis : list) axes.add(axis);
  return axes;
}

// Form writes and reads one alternative of Fact. The numbers of enumerations are in the file.
template <class What>
struct Form;

template <>
struct Form<stage::MotionChanged> {
  static constexpr const char* key = "motion";
  static Json write(const stage::MotionChanged& change) {
    const stage::Motion& motion = change.motion;
    Json json = json_of(motion);
    json["created"] = nanos_of(motion.created);
    json["started"] = nanos_of(motion.started);
    json["ended"] = nanos_of(motion.ended);
    if (motion.due) json["due"] = nanos_of(*motion.due);
    return json;
  }
  static stage::MotionChanged read(const Json& json) {
    stage::Motion motion = motion_of(json);
    motion.created = time_of(json.at("created"));
    motion.started = time_of(json.at("started"));
    motion.ended = time_of(json.at("ended"));
    if (json.contains("due")) motion.due = time_of(json.at("due"));
    return {std::move(motion)};
  }
};

template <>
struct Form<stage::CompletionSeen> {
  static constexpr const char* key = "completion";
  static Json write(const stage::CompletionSeen& seen) {
    return {{"axis", seen.axis}, {"motion", seen.motion}, {"deduced", seen.deduced}};
  }
  static stage::CompletionSeen read(const Json& json) {
    return {.axis = json.at("axis"), .motion = json.at("motion"), .deduced = json.at("deduced")};
  }
};

template <>
struct Form<stage::PathProgress> {
  static constexpr const char* key = "path";
  static Json write(const stage::PathProgress& progress) {
    return {{"motion", progress.motion},
            {"step", static_cast<int>(progress.step)},
            {"segment", progress.segment},
            {"wire_reply", progress.wire_reply}};
  }
  static stage::PathProgress read(const Json& json) {
    return {.motion = json.at("motion"),
            .step = static_cast<stage::PathProgress::Step>(json.at("step").get<int>()),
            .segment = json.at("segment"),
            .wire_reply = json.at("wire_reply")};
  }
};

template <>
struct Form<stage::LinkChanged> {
  static constexpr const char* key = "link";
  static Json write(const stage::LinkChanged& change) {
    return {{"link", static_cast<int>(change.link)},
            {"why", change.why},
            {"controllable", change.controllable.list()},
            {"serial_number", change.serial_number}};
  }
  static stage::LinkChanged read(const Json& json) {
    return {.link = static_cast<stage::LinkState>(json.at("link").get<int>()),
            .why = json.at("why"),
            .controllable = axes_in(json.at("controllable")),
            .serial_number = json.at("serial_number")};
  }
};

template <>
struct Form<stage::StopRequested> {
  static constexpr const char* key = "stop";
  static Json write(const stage::StopRequested& stop) {
    return {{"axes", stop.axes.list()}, {"emergency", stop.emergency}, {"who", stop.who}, {"count", stop.count}};
  }
  static stage::StopRequested read(const Json& json) {
    return {.axes = axes_in(json.at("axes")),
            .emergency = json.at("emergency"),
            .who = json.at("who"),
            .count = json.value("count", std::int64_t{1})};
  }
};

template <>
struct Form<stage::StopChanged> {
  static constexpr const char* key = "stop_changed";
  static Json write(const stage::StopChanged& change) {
    const stage::Stop& stop = change.stop;
    Json places = Json::array();
    for (const auto& [axis, pulses] : stop.came_to) places.push_back({axis, pulses});
    return {{"id", stop.id},
            {"kind", static_cast<int>(stop.kind)},
            {"axes", stop.axes.list()},
            {"state", static_cast<int>(stop.state)},
            {"callers", stop.callers},
            {"took_us", std::chrono::duration_cast<std::chrono::microseconds>(stop.ended - stop.asked).count()},
            {"late", stop.late},
            {"stale", stop.stale},
            {"replaced_by", stop.replaced_by},
            {"withdrawn_by", stop.withdrawn_by},
            {"came_to", std::move(places)}};
  }
  // Restores the times relative to the request.
  static stage::StopChanged read(const Json& json) {
    stage::Stop stop;
    stop.id = json.at("id");
    stop.kind = static_cast<stage::StopKind>(json.at("kind").get<int>());
    stop.axes = axes_in(json.at("axes"));
    stop.state = static_cast<stage::StopState>(json.at("state").get<int>());
    stop.callers = json.at("callers").get<std::vector<std::string>>();
    stop.ended = stop.asked + std::chrono::microseconds(json.at("took_us").get<std::int64_t>());
    stop.late = json.at("late");
    stop.stale = json.at("stale");
    stop.replaced_by = json.at("replaced_by");
    stop.withdrawn_by = json.at("withdrawn_by");
    for (const Json& place : json.at("came_to")) stop.came_to[place.at(0)] = place.at(1);
    return {std::move(stop)};
  }
};

template <>
struct Form<stage::EmergencyLatchChanged> {
  static constexpr const char* key = "emergency_latch";
  static Json write(const stage::EmergencyLatchChanged& change) {
    return {{"latched", change.latch.has_value()}, {"who", change.who}};
  }
  static stage::EmergencyLatchChanged read(const Json& json) {
    stage::EmergencyLatchChanged change{.latch = {}, .who = json.at("who")};
    if (json.at("latched")) change.latch = stage::EmergencyLatch{change.who, {}};
    return change;
  }
};

template <>
struct Form<stage::ForeignMotion> {
  static constexpr const char* key = "foreign_motion";
  static Json write(const stage::ForeignMotion& motion) { return motion.axes.list(); }
  static stage::ForeignMotion read(const Json& json) { return {axes_in(json)}; }
};

template <>
struct Form<stage::ConditionChanged> {
  static constexpr const char* key = "condition";
  static Json write(const stage::ConditionChanged& change) {
    return {{"condition", static_cast<int>(change.condition)},
            {"axes", change.axes.list()},
            {"begun", change.begun},
            {"value", change.value},
            {"before", nanos_of(change.before)},
            {"seen", nanos_of(change.seen)}};
  }
  static stage::ConditionChanged read(const Json& json) {
    return {.condition = static_cast<stage::Condition>(json.at("condition").get<int>()),
            .axes = axes_in(json.at("axes")),
            .begun = json.at("begun"),
            .value = json.at("value"),
            .before = time_of(json.at("before")),
            .seen = time_of(json.at("seen"))};
  }
};

template <>
struct Form<stage::SwitchesChanged> {
  static constexpr const char* key = "switches";
  static Json write(const stage::SwitchesChanged& change) {
    Json changes = Json::array();
    for (const auto& one : change.changes) {
      changes.push_back({{"item", one.item}, {"number", one.number}, {"before", one.before}, {"after", one.after}});
    }
    return {{"who", change.who}, {"changes", std::move(changes)}, {"unknown", change.unknown}};
  }
  static stage::SwitchesChanged read(const Json& json) {
    stage::SwitchesChanged change{.who = json.at("who"), .changes = {}, .unknown = json.at("unknown")};
    for (const Json& one : json.at("changes")) {
      change.changes.push_back({one.at("item"), one.at("number"), one.at("before"), one.at("after")});
    }
    return change;
  }
};

template <>
struct Form<stage::ProgramNotice> {
  static constexpr const char* key = "program";
  static Json write(const stage::ProgramNotice& notice) {
    return {{"kind", static_cast<int>(notice.kind)}, {"count", notice.count}};
  }
  static stage::ProgramNotice read(const Json& json) {
    return {.kind = static_cast<stage::ProgramNotice::Kind>(json.at("kind").get<int>()), .count = json.at("count")};
  }
};

template <>
struct Form<DaemonStarted> {
  static constexpr const char* key = "daemon_started";
  static Json write(const DaemonStarted& started) { return {{"after_unclean_end", started.after_unclean_end}}; }
  static DaemonStarted read(const Json& json) { return {.after_unclean_end = json.at("after_unclean_end")}; }
};

template <>
struct Form<JobChanged> {
  using Texts = std::vector<std::string>;
  static constexpr const char* key = "job";
  static Json write(const JobChanged& change) {
    const jobs::Job& job = change.job;
    Json json{
        {"number", job.number}, {"name", job.name},
        {"owner", job.owner},   {"setup", {job.setup.digest, job.setup.profile, job.setup.origin, job.setup.tool}},
        {"bytes", job.bytes},   {"state", static_cast<int>(job.state)},
        {"who", change.who},    {"why", change.why}};
    if (job.confirmation) json["confirmed"] = {job.confirmation->by, nanos_of(job.confirmation->until)};
    if (job.written) json["written"] = {job.written->least, job.written->most};
    if (!job.setup.left.empty()) json["left"] = job.setup.left;
    if (job.setup.from) json["from"] = {job.setup.from->offset, job.setup.from->line, job.setup.from->column};
    if (job.part != 0) json["part"] = job.part;
    for (const jobs::JobPart& part : job.parts) {
      json["parts"].push_back({part.tool, part.end, part.takes.least.count(), part.takes.most.count()});
    }
    if (change.sending) json["sending"] = static_cast<int>(*change.sending);
    return json;
  }
  static JobChanged read(const Json& json) {
    const Json& setup = json.at("setup");
    JobChanged change{
        .job = {.number = json.at("number"),
                .name = json.at("name"),
                .owner = json.at("owner"),
                .setup = {setup.at(0), setup.at(1), setup.at(2), setup.at(3), json.value("left", Texts()), {}},
                .bytes = json.at("bytes"),
                .state = static_cast<jobs::JobState>(json.at("state").get<int>())},
        .who = json.at("who"),
        .why = json.at("why")};
    if (json.contains("confirmed")) {
      const Json& confirmed = json.at("confirmed");
      change.job.confirmation = jobs::Confirmation{confirmed.at(0), time_of(confirmed.at(1))};
    }
    if (json.contains("written")) change.job.written = {json.at("written").at(0), json.at("written").at(1)};
    if (json.contains("from")) {
      const Json& from = json.at("from");
      change.job.setup.from = jobs::Place{from.at(0), from.at(1), from.at(2)};
    }
    change.job.part = json.value("part", std::size_t{0});
    for (const Json& part : json.value("parts", Json::array())) {
      const jobs::TimeRange takes{Duration(part.at(2)), Duration(part.at(3))};
      change.job.parts.push_back({part.at(0), part.at(1), takes, {}});
    }
    if (json.contains("sending")) change.sending = static_cast<jobs::SenderState>(json.at("sending").get<int>());
    return change;
  }
};

Json clock_json(const Moment& clock) {
  return {{"monotonic", nanos_of(clock.monotonic)}, {"wall", nanoseconds(clock.wall.time_since_epoch()).count()}};
}

Moment clock_of(const Json& json) {
  return {time_of(json.at("monotonic")), WallTime(nanoseconds(json.at("wall").get<std::int64_t>()))};
}

template <class... What>
std::optional<Fact> read_any(const Json& json, const std::variant<What...>*) {
  std::optional<Fact> fact;
  const auto try_as = [&](auto form) {
    if (json.contains(form.key)) fact = form.read(json.at(form.key));
  };
  (try_as(Form<What>()), ...);
  return fact;
}

}  // namespace

std::string text_of(const FactRecord& record) {
  Json json{{"clock", clock_json(record.clock)}};
  std::visit(
      [&](const auto& what) {
        using What = Form<std::decay_t<decltype(what)>>;
        json[What::key] = What::write(what);
      },
      record.fact);
  return json_text(json);
}

std::optional<FactRecord> fact_in(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    std::optional<Fact> fact = read_any(json, static_cast<const Fact*>(nullptr));
    if (!fact) return std::nullopt;
    FactRecord record;
    record.fact = *std::move(fact);
    record.clock = clock_of(json.at("clock"));
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace axisgate::server::journal
