#include "server/devices/after_crash.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "device/link/clock.h"
#include "server/access/access.h"
#include "server/explain.h"
#include "server/journal/answers.h"
#include "server/journal/body.h"

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

// How a motion ended, as far as is known.
struct Ending {
  MotionState state = MotionState::unknown;
  std::optional<Problem> problem{};
  std::optional<StartedMotion> started{};  // as the record has it

  bool was_not_sent() const { return problem && problem->reason == Reason::not_sent; }
};

Ending ending_of(const StartedMotion& started) {
  if (!stage::is_outcome(started.state)) return {MotionState::unknown, kUnknown, started};
  const bool well = started.state == MotionState::succeeded;
  return {started.state, well ? std::nullopt : std::optional(kUnknown), started};
}

// Of a device.
struct OnRecord {
  std::optional<StartedMotions> started;  // nothing: any may have been
  stage::MotionId last_in_journal = 0;

  // Of a motion that is not among those kept. 0: its number is not in the journal, so it is behind all that are.
  bool may_have_started(stage::MotionId number) const {
    return !started || (number == 0 ? last_in_journal + 1 : number) <= started->dropped_through;
  }
};

// The newest of those chosen.
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

// By device. To be read before anything is appended.
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
  // Its entry may not have been committed any more. Then only the record has its number.
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

// As the entry of the request had it, with its end.
journal::Entry end_of(const journal::StoredEntry& requested, const Ending& ending) {
  Json body = Json::parse(requested.entry.body, nullptr, false);
  if (!body.is_object()) body = Json::object();
  body["outcome"] = name(ending.state);
  if (ending.problem) body["reason"] = name(ending.problem->reason);
  // settle_what_was_left() writes so of what has an id.
  if (ending.state == MotionState::failed && body.contains("request_id")) body["refused"] = true;
  return entry_of(EntryKind::motion_ended, requested.entry.device, requested.entry.who, requested.entry.motion, body);
}

void end_motions(Journal& journal, const StartedBefore& started) {
  const auto left = journal.unfinished_motions();
  if (!left) return spdlog::warn("{}", explain(left.error()));
  for (const journal::StoredEntry& requested : *left) {
    const Ending ending =
        find_ending({started(requested.entry.device)}, requested.entry.motion,
                    [&](const StartedMotion& motion) { return motion.motion == requested.entry.motion; });
    journal.append({end_of(requested, ending)});
  }
}

}  // namespace

void settle_what_was_left(Journal* journal, RequestMemory& requests, const StartedBefore& started) {
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
  if (journal != nullptr) end_motions(*journal, started);
}

}  // namespace axisgate::server
