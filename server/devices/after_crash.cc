#include "server/devices/after_crash.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "device/core/explain.h"
#include "device/link/clock.h"
#include "server/access/access.h"
#include "server/journal/answers.h"
#include "server/journal/body.h"
#include "server/log.h"

namespace axisgate::server {
namespace {

using journal::EntryKind;
using journal::Journal;
using journal::RememberedRequest;
using journal::RequestChange;
using journal::RequestMemory;
using stage::MotionState;
using Json = nlohmann::json;

const Problem kNotSent{.reason = Reason::not_sent,
                       .message = "the daemon ended before the motion was sent",
                       .hint = "nothing of it was sent: it can be requested again"};
const Problem kUnknown{.reason = Reason::outcome_unknown,
                       .message = "the daemon ended without knowing the outcome; its start may have been sent",
                       .hint = "look where the stage is; it is never sent again"};

// Known end of a motion.
struct Ending {
  MotionState state = MotionState::unknown;
  std::optional<Problem> problem{};
  std::optional<StartedMotion> started{};  // the motion's entry in the record; nullopt: not there

  bool was_not_sent() const { return problem && problem->reason == Reason::not_sent; }
};

Ending ending_of(const StartedMotion& started) {
  if (!stage::is_outcome(started.state)) return {MotionState::unknown, kUnknown, started};
  const bool well = started.state == MotionState::succeeded;
  return {started.state, well ? std::nullopt : std::optional(kUnknown), started};
}

// Records of one device.
struct OnRecord {
  std::optional<StartedMotions> started;  // nullopt: any motion may have been started
  stage::MotionId last_in_journal = 0;

  // Reports whether a motion that is not among the kept ones may have been started. 0: the number is not in the
  // journal, so it is higher than all that are.
  bool may_have_started(stage::MotionId number) const {
    return !started || (number == 0 ? last_in_journal + 1 : number) <= started->dropped_through;
  }
};

// Ending of the newest motion for which `chosen` returns true.
template <class Chosen>
Ending find_ending(const OnRecord& record, stage::MotionId number, Chosen chosen) {
  if (record.started) {
    const auto& kept = record.started->kept;
    const auto found = std::find_if(kept.rbegin(), kept.rend(), chosen);
    if (found != kept.rend()) return ending_of(*found);
  }
  return record.may_have_started(number) ? Ending{MotionState::unknown, kUnknown}
                                         : Ending{MotionState::failed, kNotSent};
}

// Returns the records by device. Call it before anything is appended to the journal.
std::map<std::string, OnRecord> read_records(const Journal* journal, const std::vector<RememberedRequest>& open,
                                             const StartedBefore& started) {
  std::map<std::string, OnRecord> records;
  for (const RememberedRequest& request : open) {
    if (records.contains(request.device)) continue;
    const auto last = journal == nullptr ? 0 : journal->last_motion(request.device).value_or(0);
    records[request.device] = {started(request.device), last};
  }
  return records;
}

stage::Motion ended(const RememberedRequest& request, const Ending& ending) {
  stage::Motion motion = journal::motion_in(request.answer).value_or(stage::Motion());
  motion.id = ending.started ? ending.started->motion : request.motion;
  if (ending.started) motion.who = ending.started->who;
  motion.state = ending.state;
  motion.problem = ending.problem;
  motion.request_id = request.id;
  motion.ended = monotonic_now();
  return motion;
}

std::optional<RequestChange> settle(RequestMemory& requests, const RememberedRequest& request, const OnRecord& record) {
  const RequestMemory::Key key{request.identity, request.id};
  if (!request.moves) return requests.ended(key, journal::answer_of(kUnknown));
  const auto is_its = [&](const StartedMotion& motion) {
    if (request.motion != 0) return motion.motion == request.motion;
    return identity_of(motion.who) == request.identity && motion.request_id == request.id;
  };
  const Ending ending = find_ending(record, request.motion, is_its);
  if (ending.was_not_sent()) return requests.refused(key, *ending.problem);
  // The entry may not have been committed, and then only the record has the motion's number.
  if (ending.started) requests.made(key, ending.started->motion, request.answer);
  return requests.ended(key, journal::answer_of(ended(request, ending)));
}

journal::Entry entry_of(EntryKind kind, std::string device, std::string who, std::uint64_t motion, const Json& body) {
  return {.kind = kind,
          .time = std::chrono::system_clock::now(),
          .boot_time = monotonic_now(),
          .device = std::move(device),
          .who = std::move(who),
          .motion = motion,
          .body = journal::json_text(body)};
}

// Returns the entry of the request, with the motion's end added.
journal::Entry end_of(const journal::StoredEntry& requested, const Ending& ending) {
  Json body = Json::parse(requested.entry.body, nullptr, false);
  if (!body.is_object()) body = Json::object();
  body["outcome"] = name(ending.state);
  if (ending.problem) body["reason"] = name(ending.problem->reason);
  // settle_what_was_left() writes the refusal of a request with an id.
  if (ending.state == MotionState::failed && body.contains("request_id")) body["refused"] = true;
  return entry_of(EntryKind::motion_ended, requested.entry.device, requested.entry.who, requested.entry.motion, body);
}

// Returns an empty string if somebody has changed the file.
std::string text_in(const Json& body, const char* key) {
  const auto found = body.find(key);
  return found != body.end() && found->is_string() ? found->get<std::string>() : "";
}

// Returns the value with this name, up to `last`; nullopt if no value has it.
template <class Named>
std::optional<Named> named(std::string_view text, Named last) {
  for (int value = 0; value <= static_cast<int>(last); ++value) {
    if (name(static_cast<Named>(value)) == text) return static_cast<Named>(value);
  }
  return std::nullopt;
}

// Returns nullopt if the journal has no end of the motion.
std::optional<Ending> ending_on_record(const Journal& journal, const std::string& device, stage::MotionId id) {
  const auto found = journal.read({.device = device, .motion = id, .kinds = {EntryKind::motion_ended}}, 1);
  if (!found || found->empty()) return std::nullopt;
  const Json body = Json::parse(found->front().entry.body, nullptr, false);
  const auto state = named(text_in(body, "outcome"), MotionState::unknown);
  if (!state || !stage::is_outcome(*state)) return std::nullopt;
  if (*state == MotionState::succeeded) return Ending{*state, {}};
  const Reason reason = named(text_in(body, "reason"), kLastReason).value_or(Reason::outcome_unknown);
  return Ending{*state, Problem{.reason = reason,
                                .message = "the daemon ended before it reported this; the details are not on record",
                                .hint = "look at the history of the motion: `ListHistory`"}};
}

// Returns the request as a fact, for a motion whose facts were not written.
FactRecord fact_of(const journal::Entry& requested) {
  stage::Motion motion;
  motion.id = requested.motion;
  motion.who = requested.who;
  motion.created = requested.boot_time;
  const Json body = Json::parse(requested.body, nullptr, false);
  motion.kind = named(text_in(body, "kind"), stage::MotionKind::scan).value_or(motion.kind);
  motion.request_id = text_in(body, "request_id");
  const auto axes = body.find("axes");
  for (const Json& axis : axes == body.end() ? Json::array() : *axes) {
    if (axis.is_number_integer() && axis >= 1 && axis <= stage::kAxesMax) motion.axes.add(axis.get<int>());
  }
  const Moment clock{requested.boot_time, requested.time};
  return {.device = requested.device, .fact = stage::MotionChanged{std::move(motion)}, .clock = clock};
}

// `newest`: the newest fact about the motion.
void publish_end(EventBus& bus, const FactRecord& newest, const Ending& ending) {
  const WallTime now = std::chrono::system_clock::now();
  stage::MotionChanged change = std::get<stage::MotionChanged>(newest.fact);
  change.motion.state = ending.state;
  change.motion.problem = ending.problem;
  change.motion.ended = newest.clock.of(now);
  bus.publish(newest.device, std::move(change), now, newest.clock);
}

void end_unfinished(Journal& journal, EventBus& bus, const StartedBefore& started) {
  const auto left = journal.unfinished_motions();
  if (!left) return log::warn("{}", explain(left.error()));
  for (const journal::StoredEntry& requested : *left) {
    const journal::Entry& entry = requested.entry;
    const Ending ending = find_ending({started(entry.device)}, entry.motion,
                                      [&](const StartedMotion& motion) { return motion.motion == entry.motion; });
    journal.append({end_of(requested, ending)});
    const FactPointer newest = bus.find_motion(entry.device, entry.motion);
    publish_end(bus, newest ? *newest : fact_of(entry), ending);
  }
}

// Publishes ends that the journal has and the bus lacks: a fact is written after the entry about the same event.
void publish_missing_ends(const Journal& journal, EventBus& bus) {
  for (const FactPointer& newest : bus.open_motions()) {
    const stage::MotionId id = std::get<stage::MotionChanged>(newest->fact).motion.id;
    publish_end(bus, *newest, ending_on_record(journal, newest->device, id).value_or(Ending{.problem = kUnknown}));
  }
}

}  // namespace

void settle_what_was_left(Journal* journal, RequestMemory& requests, EventBus& bus, const StartedBefore& started) {
  const std::vector<RememberedRequest> open = requests.open();
  const auto records = read_records(journal, open, started);
  for (const RememberedRequest& request : open) {
    auto change = settle(requests, request, records.at(request.device));
    if (journal == nullptr || !change) continue;
    const EntryKind kind = change->forget ? EntryKind::request_refused : EntryKind::request_ended;
    const auto motion = journal::motion_in(request.answer);
    const std::uint64_t number = change->request.motion;
    const Json body{{"request", motion ? name(motion->kind) : "request"},
                    {"request_id", request.id},
                    {change->forget ? "reason" : "outcome", change->forget ? "NOT_SENT" : "UNKNOWN"}};
    journal->append({entry_of(kind, request.device, request.identity, number, body), *std::move(change)});
  }
  if (journal == nullptr) return;
  end_unfinished(*journal, bus, started);
  publish_missing_ends(*journal, bus);
}

}  // namespace axisgate::server
