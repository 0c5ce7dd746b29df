#include "server/proto/history.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <string>
#include <string_view>

#include "server/api/request/axis_names.h"
#include "server/api/request/names.h"
#include "server/journal/device_entries.h"
#include "server/proto/amounts.h"
#include "server/proto/callers.h"
#include "server/proto/motions.h"
#include "server/proto/shown.h"
#include "server/proto/to_proto.h"

namespace axisgate::proto {
namespace {

using google::protobuf::util::TimeUtil;
using server::WallTime;
using server::journal::EntryKind;
using server::journal::Filter;
using server::journal::Head;
using server::journal::Span;
using server::journal::StoredEntry;

static_assert(static_cast<int>(EntryKind::entries_left_out) == v1::HISTORY_KIND_ENTRIES_LEFT_OUT);
static_assert(static_cast<int>(EntryKind::motion_ended) == v1::HISTORY_KIND_MOTION_ENDED);
static_assert(static_cast<int>(EntryKind::stop_requested) == v1::HISTORY_KIND_STOP_REQUESTED);
static_assert(static_cast<int>(EntryKind::emergency_cleared) == v1::HISTORY_KIND_EMERGENCY_CLEARED);
static_assert(static_cast<int>(EntryKind::foreign_motion) == v1::HISTORY_KIND_FOREIGN_MOTION);
static_assert(static_cast<int>(EntryKind::condition_changed) == v1::HISTORY_KIND_CONDITION_CHANGED);
static_assert(static_cast<int>(EntryKind::switches_changed) == v1::HISTORY_KIND_SWITCHES_CHANGED);
static_assert(static_cast<int>(EntryKind::request_ended) == v1::HISTORY_KIND_REQUEST_ENDED);
static_assert(static_cast<int>(EntryKind::lines_exchanged) == v1::HISTORY_KIND_LINES_EXCHANGED);
static_assert(static_cast<int>(EntryKind::lease_granted) == v1::HISTORY_KIND_LEASE_GRANTED);
static_assert(static_cast<int>(EntryKind::rearmed) == v1::HISTORY_KIND_REARMED);
static_assert(static_cast<int>(EntryKind::person_erased) == v1::HISTORY_KIND_PERSON_ERASED);
static_assert(static_cast<int>(EntryKind::job_changed) == v1::HISTORY_KIND_JOB_CHANGED);

// A Timestamp reaches further than a WallTime.
WallTime wall_time(const google::protobuf::Timestamp& time) {
  constexpr auto most = std::chrono::floor<std::chrono::microseconds>(WallTime::max().time_since_epoch());
  const std::chrono::microseconds since(TimeUtil::TimestampToMicroseconds(time));
  return WallTime(std::clamp(since, -most, most));
}

// "return-to-origin", as stage::name() gives it.
v1::MotionKind motion_kind(std::string_view name) {
  std::string text = "MOTION_KIND_";
  for (const char c : name) text += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  v1::MotionKind kind = v1::MOTION_KIND_UNSPECIFIED;
  v1::MotionKind_Parse(text, &kind);
  return kind;
}

v1::MotionState motion_state(const std::string& name) {
  v1::MotionState state = v1::MOTION_STATE_UNSPECIFIED;
  v1::MotionState_Parse("MOTION_STATE_" + name, &state);
  return state;
}

v1::PersonSummary message_of(const server::journal::PersonSummary& person) {
  v1::PersonSummary proto;
  if (!person.who.empty()) *proto.mutable_caller() = to_caller(person.who);
  *proto.mutable_first_time() = to_proto(person.first);
  *proto.mutable_last_time() = to_proto(person.last);
  for (const auto& motions : person.motions) {
    v1::MotionCount& count = *proto.add_motions();
    count.set_kind(motion_kind(motions.kind));
    count.set_outcome(motion_state(motions.outcome));
    count.set_count(motions.count);
  }
  proto.set_refused(person.refused);
  return proto;
}

v1::LateStop message_of(const server::journal::LateStop& stop) {
  v1::LateStop proto;
  *proto.mutable_time() = to_proto(stop.time);
  if (!stop.who.empty()) *proto.mutable_caller() = to_caller(stop.who);
  proto.set_device(api::device_name(stop.device));
  proto.set_emergency(stop.emergency);
  *proto.mutable_elapsed_time() = to_proto(stop.after);
  proto.set_confirmed(stop.confirmed);
  return proto;
}

v1::StopSummary message_of(const server::journal::StopSummary& stop) {
  v1::StopSummary proto;
  *proto.mutable_time() = to_proto(stop.time);
  if (!stop.who.empty()) *proto.mutable_caller() = to_caller(stop.who);
  proto.set_device(api::device_name(stop.device));
  proto.set_emergency(stop.emergency);
  return proto;
}

v1::ConditionSummary message_of(const server::journal::ConditionSummary& condition) {
  v1::ConditionSummary proto;
  proto.set_device(api::device_name(condition.device));
  proto.set_condition(to_condition(stage::condition_named(condition.condition)));
  for (const int axis : condition.axes) proto.add_axes(axis);
  proto.set_begun(condition.begun);
  proto.set_value(condition.value);
  if (condition.before) *proto.mutable_before_time() = to_proto(*condition.before);
  *proto.mutable_seen_time() = to_proto(condition.seen);
  return proto;
}

v1::LinkLoss message_of(const server::journal::LinkLoss& loss) {
  v1::LinkLoss proto;
  proto.set_device(api::device_name(loss.device));
  *proto.mutable_down_time() = to_proto(loss.down);
  if (loss.up) *proto.mutable_up_time() = to_proto(*loss.up);
  return proto;
}

v1::DaemonStart message_of(const server::journal::DaemonStart& start) {
  v1::DaemonStart proto;
  *proto.mutable_time() = to_proto(start.time);
  proto.set_after_unclean_end(start.after_unclean_end);
  return proto;
}

// The number of the last entry of the page before; 0: there was none.
Result<std::int64_t> to_last(const std::string& page_token) {
  std::int64_t last = 0;
  const auto [end, error] = std::from_chars(page_token.data(), page_token.data() + page_token.size(), last);
  const bool good = error == std::errc() && end == page_token.data() + page_token.size() && last > 0;
  if (page_token.empty() || good) return last;
  return fail(Reason::invalid_request, "page_token is none that ListHistory answered",
              "give the next_page_token of the page before");
}

// Empty: all.
Result<std::string> to_device(const server::Gateway& gateway, const std::string& name) {
  if (name.empty()) return "";
  return api::find_device(gateway, name).map([](const server::Device* device) { return device->name(); });
}

Result<std::string> to_outcome(v1::MotionState outcome) {
  if (outcome == v1::MOTION_STATE_UNSPECIFIED) return "";
  if (outcome >= v1::MOTION_STATE_SUCCEEDED && outcome <= v1::MOTION_STATE_UNKNOWN) {
    return v1::MotionState_Name(outcome).substr(std::string_view("MOTION_STATE_").size());
  }
  return fail(Reason::invalid_request, "outcome is a state of a motion that has not ended",
              "give SUCCEEDED, STOPPED, FAILED or UNKNOWN");
}

}  // namespace

v1::HistoryEntry to_proto(const server::Gateway& gateway, const StoredEntry& stored) {
  const auto& entry = stored.entry;
  v1::HistoryEntry proto;
  proto.set_number(stored.number);
  *proto.mutable_time() = to_proto(entry.time);
  proto.set_kind(static_cast<v1::HistoryKind>(entry.kind));
  if (!entry.device.empty()) proto.set_device(api::device_name(entry.device));
  if (!entry.who.empty()) *proto.mutable_caller() = to_caller(entry.who);
  if (entry.motion != 0) proto.set_motion(api::motion_name(entry.device, entry.motion));
  proto.set_details(entry.body);
  const Shown shown(gateway.find_stage(entry.device));
  for (const stage::AxisResult& result : server::journal::results_in(entry.body)) {
    *proto.add_results() = to_proto(result, shown);
  }
  return proto;
}

v1::JournalHead to_proto(const Head& head) {
  v1::JournalHead proto;
  proto.set_epoch(head.epoch);
  proto.set_number(head.number);
  proto.set_hash(head.hash.data(), head.hash.size());
  return proto;
}

void fill_summary(v1::SummarizeHistoryResponse& proto, const api::HistorySummary& answer) {
  const server::journal::Summary& summary = answer.summary;
  proto.set_own_only(answer.own_only);
  for (const auto& person : summary.persons.items) *proto.add_persons() = message_of(person);
  proto.set_more_persons(summary.persons.more);
  for (const auto& stop : summary.stops.items) *proto.add_stops() = message_of(stop);
  proto.set_more_stops(summary.stops.more);
  for (const auto& stop : summary.late_stops.items) *proto.add_late_stops() = message_of(stop);
  proto.set_more_late_stops(summary.late_stops.more);
  for (const auto& condition : summary.conditions.items) *proto.add_conditions() = message_of(condition);
  proto.set_more_conditions(summary.conditions.more);
  for (const auto& loss : summary.losses.items) *proto.add_link_losses() = message_of(loss);
  proto.set_more_link_losses(summary.losses.more);
  for (const auto& start : summary.starts.items) *proto.add_daemon_starts() = message_of(start);
  proto.set_more_daemon_starts(summary.starts.more);
}

Result<std::optional<Head>> to_head(const v1::VerifyJournalRequest& request) {
  if (!request.has_noted()) return std::nullopt;
  Head head{request.noted().epoch(), request.noted().number(), {}};
  const std::string& hash = request.noted().hash();
  if (hash.size() != head.hash.size()) {
    return fail(Reason::invalid_request, "noted.hash is not 32 bytes long", "give a head as VerifyJournal answered it");
  }
  std::ranges::copy(hash, head.hash.begin());
  return head;
}

Result<Span> to_span(const server::Gateway& gateway, const v1::SummarizeHistoryRequest& request) {
  Span span;
  if (request.has_start_time()) span.from = wall_time(request.start_time());
  if (request.has_end_time()) span.to = wall_time(request.end_time());
  return to_device(gateway, request.device()).map([&](std::string device) {
    span.device = std::move(device);
    return span;
  });
}

Result<Filter> to_filter(const server::Gateway& gateway, const v1::ListHistoryRequest& request) {
  Filter filter;
  if (request.has_start_time()) filter.from = wall_time(request.start_time());
  if (request.has_end_time()) filter.to = wall_time(request.end_time());
  const auto device = to_device(gateway, request.device());
  if (!device) return tl::unexpected(device.error());
  filter.device = *device;
  if (!request.motion().empty()) {
    const auto motion = api::find_motion_name(gateway, request.motion());
    if (!motion) return tl::unexpected(motion.error());
    filter.device = motion->device->name();
    filter.motion = motion->id;
  }
  filter.who = request.caller();
  for (const int kind : request.kinds()) filter.kinds.push_back(static_cast<EntryKind>(kind));
  const auto outcome = to_outcome(request.outcome());
  if (!outcome) return tl::unexpected(outcome.error());
  filter.outcome = *outcome;
  if (!request.axis().empty()) {
    const Result<int> axis = api::axis_names(gateway, request.device()).find(request.axis());
    if (!axis) return tl::unexpected(axis.error());
    filter.axis = *axis;
  }
  filter.text = request.text();
  filter.after = request.after();
  filter.oldest_first = request.order() == v1::ListHistoryRequest::ORDER_OLDEST_FIRST;
  const auto last = to_last(request.page_token());
  if (!last) return tl::unexpected(last.error());
  if (filter.oldest_first) {
    filter.after = std::max(filter.after, *last);
  } else {
    filter.before = *last;
  }
  return filter;
}

std::string page_token_after(const StoredEntry& last) { return fmt::format("{}", last.number); }

}  // namespace axisgate::proto
