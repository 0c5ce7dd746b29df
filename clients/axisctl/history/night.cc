#include "clients/axisctl/history/night.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/axisctl/condition_text.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/history/history_reader.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

using google::protobuf::Timestamp;
using google::protobuf::util::TimeUtil;

// Deadline of the summary: the daemon reads every entry of a long period.
constexpr std::chrono::seconds kSummaryLimit{60};
constexpr int kEvening = 18;  // o'clock

std::tm local_time(std::time_t time) {
  std::tm local{};
  ::localtime_r(&time, &local);
  return local;
}

std::time_t evening_before(std::time_t now) {
  std::tm evening = local_time(now);
  --evening.tm_mday;
  evening.tm_hour = kEvening;
  evening.tm_min = evening.tm_sec = 0;
  evening.tm_isdst = -1;
  return std::mktime(&evening);
}

// A NightClock formats times: "23:10" in the last 24 hours, otherwise "11-24 23:10". The offset from UTC is shown if it
// differs from that of the beginning: when the clocks are set back, one hour occurs twice.
class NightClock {
 public:
  NightClock(std::time_t from, std::time_t to)
      : from_(from), offset_(local_time(from).tm_gmtoff), unambiguous_(to - from <= 24 * 3600) {}

  std::string text(const Timestamp& time) const {
    const std::time_t seconds = TimeUtil::TimestampToTimeT(time);
    const std::tm local = local_time(seconds);
    char text[32];
    std::strftime(text, sizeof text, unambiguous_ && seconds >= from_ ? "%H:%M" : "%m-%d %H:%M", &local);
    return local.tm_gmtoff == offset_ ? text : text + utc_offset(local);
  }

 private:
  std::time_t from_;
  long offset_;  // seconds east of UTC
  bool unambiguous_;
};

std::string_view plural_of(v1::MotionKind kind) {
  switch (kind) {
    case v1::MOTION_KIND_MOVE:
      return "moves";
    case v1::MOTION_KIND_HOME:
      return "homings";
    case v1::MOTION_KIND_RETURN_TO_ORIGIN:
      return "returns to origin";
    case v1::MOTION_KIND_PATH:
      return "paths";
    case v1::MOTION_KIND_EXECUTE:
      return "raw commands";
    case v1::MOTION_KIND_JOG:
      return "jogs";
    case v1::MOTION_KIND_SCAN:
      return "scans";
    default:
      return "other motions";
  }
}

std::string_view singular_of(v1::MotionKind kind) {
  if (kind == v1::MOTION_KIND_RETURN_TO_ORIGIN) return "return to origin";
  return plural_of(kind).substr(0, plural_of(kind).size() - 1);
}

// Returns "412 moves (2 FAILED, 1 STOPPED)". The other 409 succeeded.
std::string motions_text(v1::MotionKind kind, const std::map<v1::MotionState, std::int64_t>& outcomes) {
  std::int64_t all = 0;
  std::vector<std::string> bad;
  for (const auto& [outcome, count] : outcomes) {
    all += count;
    if (outcome != v1::MOTION_STATE_SUCCEEDED) bad.push_back(fmt::format("{} {}", count, state_name(outcome)));
  }
  const std::string text = fmt::format("{} {}", all, all == 1 ? singular_of(kind) : plural_of(kind));
  return bad.empty() ? text : fmt::format("{} ({})", text, fmt::join(bad, ", "));
}

// Returns "23:10 to 06:42 unix anna: 412 moves, 1 scan; 3 refused".
std::string person_text(const v1::PersonSummary& person, const NightClock& clock) {
  const std::string first = clock.text(person.first_time()), last = clock.text(person.last_time());
  std::map<v1::MotionKind, std::map<v1::MotionState, std::int64_t>> by_kind;
  for (const v1::MotionCount& one : person.motions()) by_kind[one.kind()][one.outcome()] += one.count();
  std::vector<std::string> motions;
  for (const auto& [kind, outcomes] : by_kind) motions.push_back(motions_text(kind, outcomes));
  const std::string when = first == last ? first : first + " to " + last;
  const std::string refused = person.refused() == 0 ? "" : fmt::format("; {} refused", person.refused());
  return fmt::format("{} {}: {}{}", when, person.caller().name().empty() ? "an unknown caller" : person.caller().name(),
                     motions.empty() ? "no motion" : fmt::format("{}", fmt::join(motions, ", ")), refused);
}

std::string stop_text(const v1::StopSummary& stop, const NightClock& clock) {
  return fmt::format("{} of {} by {} at {}", stop.emergency() ? "emergency stop" : "stop", last_part(stop.device()),
                     stop.caller().name().empty() ? "an unknown caller" : stop.caller().name(),
                     clock.text(stop.time()));
}

std::string late_text(const v1::LateStop& stop, const NightClock& clock) {
  return fmt::format("{} of {} by {} {} at {}, {} after it was requested", stop.emergency() ? "emergency stop" : "stop",
                     last_part(stop.device()),
                     stop.caller().name().empty() ? "an unknown caller" : stop.caller().name(),
                     stop.confirmed() ? "confirmed" : "withdrawn, and never confirmed,", clock.text(stop.time()),
                     duration_text(stop.elapsed_time()));
}

std::string loss_text(const v1::LinkLoss& loss, const NightClock& clock) {
  const std::string text = fmt::format("{}: link lost at {}", last_part(loss.device()), clock.text(loss.down_time()));
  return text + (loss.has_up_time() ? " for " + duration_text(loss.down_time(), loss.up_time()) : ", not up again");
}

// Returns "stage axes 1, 2 and 3: emergency stop at 23:41, ended at 23:44". If a link was lost, the time is "between"
// two readings that may be hours apart.
std::string condition_line(const v1::ConditionSummary& one, const v1::ConditionSummary* end, const NightClock& clock) {
  const std::string seen = clock.text(one.seen_time());
  const std::string before = one.has_before_time() ? clock.text(one.before_time()) : seen;
  const bool gap = one.has_before_time() && one.seen_time() - one.before_time() > TimeUtil::SecondsToDuration(60);
  return fmt::format("{} {} {}{}", last_part(one.device()),
                     condition_text(one.condition(), one.axes(), one.begun(), one.value()),
                     gap ? between_text(before, seen) : "at " + seen,
                     end == nullptr ? "" : ", ended at " + clock.text(end->seen_time()));
}

bool is_same(const v1::ConditionSummary& one, const v1::ConditionSummary& other) {
  return one.condition() == other.condition() && one.device() == other.device();
}

using Conditions = google::protobuf::RepeatedPtrField<v1::ConditionSummary>;

// Returns the change with which the last axis left the condition; null if the night has none. The axes may leave it one
// by one. A mode has no axes; the next mode ends it.
const v1::ConditionSummary* end_of(const Conditions& all, Conditions::const_iterator one) {
  std::set<int> axes(one->axes().begin(), one->axes().end());
  for (auto other = one + 1; other != all.end(); ++other) {
    if (!is_same(*one, *other)) continue;
    if (one->axes().empty()) return &*other;
    if (other->begun()) continue;
    for (const int axis : other->axes()) axes.erase(axis);
    if (axes.empty()) return &*other;
  }
  return nullptr;
}

// Reports whether the night also has the beginning of the condition that this change ends.
bool ends_another(const Conditions& all, Conditions::const_iterator end) {
  return std::any_of(all.begin(), end, [end](const v1::ConditionSummary& one) {
    const auto touched = [&](int axis) { return std::ranges::find(one.axes(), axis) != one.axes().end(); };
    return is_same(one, *end) && (end->axes().empty() || (one.begun() && std::ranges::any_of(end->axes(), touched)));
  });
}

// Adds one line for each condition; the end of a condition is on the line of its beginning.
template <class Add>
void add_conditions(const v1::SummarizeHistoryResponse& night, const NightClock& clock, const Add& add) {
  const Conditions& all = night.conditions();
  for (auto one = all.begin(); one != all.end(); ++one) {
    if (!one->begun() && ends_another(all, one)) continue;
    add(one->seen_time(), condition_line(*one, one->begun() ? end_of(all, one) : nullptr, clock));
  }
}

std::string start_text(const v1::DaemonStart& start, const NightClock& clock) {
  return fmt::format("the daemon {} {}", start.after_unclean_end() ? "was killed; it started again at" : "started at",
                     clock.text(start.time()));
}

// Returns the lines that do not belong to one person, sorted by time.
std::vector<std::string> happenings(const v1::SummarizeHistoryResponse& night, const NightClock& clock) {
  std::vector<std::pair<std::int64_t, std::string>> timed;
  const auto add = [&](const Timestamp& time, std::string text) {
    timed.emplace_back(TimeUtil::TimestampToMicroseconds(time), std::move(text));
  };
  for (const v1::StopSummary& stop : night.stops()) add(stop.time(), stop_text(stop, clock));
  for (const v1::LateStop& stop : night.late_stops()) add(stop.time(), late_text(stop, clock));
  add_conditions(night, clock, add);
  for (const v1::LinkLoss& loss : night.link_losses()) add(loss.down_time(), loss_text(loss, clock));
  for (const v1::DaemonStart& start : night.daemon_starts()) add(start.time(), start_text(start, clock));
  std::ranges::stable_sort(timed, {}, &std::pair<std::int64_t, std::string>::first);
  std::vector<std::string> lines;
  for (auto& [time, line] : timed) lines.push_back(std::move(line));
  return lines;
}

void print_more(std::int64_t count, std::string_view what) {
  if (count > 0) print_line(fmt::format("{} more {}", count, what));
}

void print_night(const v1::SummarizeHistoryResponse& night, const NightClock& clock) {
  for (const v1::PersonSummary& person : night.persons()) {
    const bool only_stopped = person.motions().empty() && person.refused() == 0;
    if (!only_stopped) print_line(person_text(person, clock));
  }
  print_more(night.more_persons(), "callers");
  const std::vector<std::string> others = happenings(night, clock);
  for (const std::string& line : others) print_line(line);
  print_more(night.more_stops(), "stops");
  print_more(night.more_late_stops(), "late stops");
  print_more(night.more_conditions(), "changes at a stage");
  print_more(night.more_link_losses(), "losses of a link");
  print_more(night.more_daemon_starts(), "starts of the daemon");
  if (night.persons().empty() && others.empty()) print_line("nothing happened");
}

}  // namespace

int show_night(const Session& session) {
  const std::time_t now = std::time(nullptr);
  const std::time_t from = session.options.hours ? now - *session.options.hours * 3600L : evening_before(now);
  v1::SummarizeHistoryRequest request;
  *request.mutable_start_time() = TimeUtil::SecondsToTimestamp(from);
  request.set_device(session.options.device);
  const v1::SummarizeHistoryResponse night = session.connection.call(
      session.connection.history, &v1::HistoryService::Stub::SummarizeHistory, request, kSummaryLimit);
  if (session.options.json) {
    print_json(night);
    return kDone;
  }
  note_own_only(night.own_only());
  print_line(fmt::format("since {}", time_text(request.start_time())));
  print_night(night, NightClock(from, now));
  return kDone;
}

}  // namespace axisgate::axisctl
