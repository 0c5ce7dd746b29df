#include "server/devices/after_crash.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

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
};

// `started`: nothing, where any motion may have been. null in it: this one was not.
Ending ending_of(bool known, const StartedMotion* started) {
  if (!known) return {MotionState::unknown, kUnknown};
  if (started == nullptr) return {MotionState::failed, kNotSent};
  if (!stage::is_outcome(started->state)) return {MotionState::unknown, kUnknown};
  return {started->state, started->state == MotionState::succeeded ? std::nullopt : std::optional(kUnknown)};
}

template <class Chosen>
Ending find_ending(const std::optional<std::vector<StartedMotion>>& started, Chosen chosen) {
  if (!started) return ending_of(false, nullptr);
  const auto found = std::ranges::find_if(*started, chosen);
  return ending_of(true, found == started->end() ? nullptr : &*found);
}

stage::Motion ended(const RememberedRequest& request, const Ending& ending) {
  stage::Motion motion = journal::motion_in(request.answer).value_or(stage::Motion());
  motion.id = request.motion;
  motion.state = ending.state;
  motion.problem = ending.problem;
  motion.request_id = request.id;
  motion.ended = monotonic_now();
  return motion;
}

std::optional<RequestChange> settle(RequestMemory& requests, const RememberedRequest& request,
                                    const StartedBefore& started) {
  const RequestMemory::Key key{request.identity, request.id};
  if (!request.moves) return requests.ended(key, journal::answer_of(kUnknown));
  const Ending ending = find_ending(started(request.device), [&](const StartedMotion& motion) {
    return identity_of(motion.who) == request.identity && motion.request_id == request.id;
  });
  if (ending.state == MotionState::failed) return requests.refused(key, *ending.problem);
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
    const Ending ending = find_ending(started(requested.entry.device), [&](const StartedMotion& motion) {
      return motion.motion == requested.entry.motion;
    });
    journal.append({end_of(requested, ending)});
  }
}

}  // namespace

void settle_what_was_left(Journal* journal, RequestMemory& requests, const StartedBefore& started) {
  for (const RememberedRequest& request : requests.open()) {
    auto change = settle(requests, request, started);
    if (journal == nullptr || !change) continue;
    const EntryKind kind = change->forget ? EntryKind::request_refused : EntryKind::request_ended;
    const auto motion = journal::motion_in(request.answer);
    const Json body{{"request", motion ? name(motion->kind) : "request"},
                    {"request_id", request.id},
                    {change->forget ? "reason" : "outcome", change->forget ? "NOT_SENT" : "UNKNOWN"}};
    journal->append({entry_of(kind, request.device, request.identity, request.motion, body), *std::move(change)});
  }
  if (journal != nullptr) end_motions(*journal, started);
}

}  // namespace axisgate::server
