#include "clients/axisctl/history/history_text.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "clients/axisctl/condition_text.h"
#include "clients/axisctl/print.h"
#include "device/core/escape.h"
#include "device/stage/condition.h"

namespace axisgate::axisctl {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLineMax = 1000;  // longer than any line

std::string axes_text(const Json& details) {
  const Json axes = details.value("axes", Json::array());
  if (axes.is_string()) return "the whole device";
  std::string text;
  for (const Json& axis : axes) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", axis.dump());
  }
  return text.empty() ? "no axis" : (text.find(',') == std::string::npos ? "axis " : "axes ") + text;
}

std::string results_text(const Json& details) {
  std::string text;
  for (const Json& result : details.value("results", Json::array())) {
    if (!result.contains("command_pulses")) continue;
    text += fmt::format("{}axis {} at {} pulses", text.empty() ? "; " : ", ", result.value("axis", 0),
                        result.value("command_pulses", std::int64_t{}));
  }
  return text;
}

std::string motion_text(const v1::HistoryEntry& entry, const Json& details) {
  const std::string motion =
      fmt::format("motion {} ({} of {})", last_part(entry.motion()), details.value("kind", "?"), axes_text(details));
  if (entry.kind() == v1::HISTORY_KIND_MOTION_REQUESTED) return motion + " requested";
  if (entry.kind() == v1::HISTORY_KIND_MOTION_STARTED) return motion + " started";
  const std::string outcome = details.value("outcome", "?"), reason = details.value("reason", "");
  return fmt::format("{} {}{}{}", motion, outcome, reason.empty() || reason == outcome ? "" : " " + reason,
                     results_text(details));
}

std::string refusal_text(const Json& details) {
  const std::string text =
      fmt::format("refused: {}, {}", details.value("request", "a request"), details.value("reason", "?"));
  if (!details.contains("count")) return text;
  return fmt::format("{} requests refused; the last of them {}", details.value("count", std::int64_t{}), text);
}

// Returns the text for the reason of a lease's end, as its journal entry names it.
std::string ending_text(const std::string& why) {
  if (why == "handed_over") return "handed over";
  if (why == "taken_over") return "taken over by somebody else";
  if (why == "cut_off") return "its holder was cut off";
  if (why == "token_revoked") return "the token of its holder was revoked";
  if (why == "restarted") return "the controller may have restarted";
  return why;
}

std::string lease_text(const v1::HistoryEntry& entry, const Json& details) {
  const std::string lease = fmt::format("lease {} of {} over {}", details.value("lease", std::uint64_t{}),
                                        entry.caller().name(), axes_text(details));
  if (entry.kind() == v1::HISTORY_KIND_LEASE_ENDED) return lease + " ended: " + ending_text(details.value("why", "?"));
  return lease + " granted" + (details.value("taken_over", false) ? ", taken over from others" : "");
}

// Formats an exchange, which is [line, answer] or [line, answer, microseconds].
std::string exchange_text(const Json& exchange) {
  const std::string line = exchange.at(0), answer = exchange.at(1).is_null() ? "no answer" : exchange.at(1);
  return escaped(line, kLineMax) + "  " + escaped(answer, kLineMax);
}

Json lines_in(const Json& details) { return details.value("lines", Json::array()); }

std::string lines_text(const v1::HistoryEntry& entry, const Json& details) {
  const Json lines = lines_in(details);
  if (entry.motion().empty() && lines.size() == 1) return "sent: " + exchange_text(lines.front());
  return fmt::format("motion {}: {} line{}", last_part(entry.motion()), lines.size(), lines.size() == 1 ? "" : "s");
}

// Formats the time since the motion was requested.
std::string elapsed_text(std::int64_t micros) {
  return micros < 10'000'000 ? fmt::format("{} ms", micros / 1000)
                             : fmt::format("{:.1f} s", static_cast<double>(micros) / 1e6);
}

std::string job_entry_text(const Json& details, const std::string& because) {
  const Json sent = details.value("sent", Json::array());
  const std::string range =
      sent.size() == 2 ? fmt::format("; {} to {} bytes were sent", sent[0].dump(), sent[1].dump()) : "";
  return fmt::format("job {} is {}{}{}", details.value("job", std::uint64_t{}), details.value("state", "?"), range,
                     because);
}

std::string stop_text(const Json& details) {
  const std::int64_t count = details.value("count", std::int64_t{1});
  return fmt::format("{} of {}{}", details.value("emergency", false) ? "emergency stop" : "stop", axes_text(details),
                     count > 1 ? fmt::format(", {} times while nothing moved", count) : "");
}

std::string stop_end_text(const Json& details) {
  const std::string title = fmt::format("{} {} of {}", details.value("emergency", false) ? "emergency stop" : "stop",
                                        details.value("stop", std::uint64_t{}), axes_text(details));
  const std::string outcome = details.value("outcome", "?");
  if (outcome != "confirmed") return title + " " + outcome + "; nobody has seen the axes obey it";
  return fmt::format("{} confirmed after {}{}", title, elapsed_text(details.value("after_ms", std::int64_t{}) * 1000),
                     results_text(details));
}

google::protobuf::Timestamp time_in(const Json& details, const char* key) {
  return google::protobuf::util::TimeUtil::MicrosecondsToTimestamp(details.value(key, std::int64_t{}));
}

std::string change_text(const Json& details) {
  stage::AxisSet axes;
  for (const int axis : details.value("axes", std::vector<int>())) axes.add(axis);
  const std::string text = stage::words(stage::condition_named(details.value("condition", "")), axes,
                                        details.value("begun", true), details.value("value", ""));
  const std::string seen = time_text(time_in(details, "seen_us"));
  return fmt::format(
      "{}, {}", text,
      details.contains("before_us") ? between_text(time_text(time_in(details, "before_us")), seen) : found_text(seen));
}

std::string text_of(const v1::HistoryEntry& entry) {
  const Json details = Json::parse(entry.details(), nullptr, false);
  if (!details.is_object()) return entry.details();
  const std::string why = details.value("why", "");
  const std::string because = why.empty() ? "" : ": " + why;
  switch (entry.kind()) {
    case v1::HISTORY_KIND_DAEMON_STARTED:
      return "the daemon started, version " + details.value("version", "?");
    case v1::HISTORY_KIND_DAEMON_ENDED:
      return "the daemon ended";
    case v1::HISTORY_KIND_ENTRIES_LEFT_OUT:
      return fmt::format("{} entries were left out: the disk refused them", details.value("count", 0));
    case v1::HISTORY_KIND_JOURNAL_FAILED:
      return "the disk refused the journal";
    case v1::HISTORY_KIND_ENTRIES_DROPPED:
      return fmt::format("entries up to {} are no longer kept", details.value("through", std::int64_t{}));
    case v1::HISTORY_KIND_REQUEST_MADE:
      return "requested: " + details.value("what", "?");
    case v1::HISTORY_KIND_REQUEST_REFUSED:
      return refusal_text(details);
    case v1::HISTORY_KIND_REQUEST_ENDED:
      return fmt::format("{}: {}", details.value("request", "a request"), details.value("outcome", "?"));
    case v1::HISTORY_KIND_PERSON_ERASED:
      return fmt::format("the name of caller {} was erased", details.value("person", std::int64_t{}));
    case v1::HISTORY_KIND_MOTION_REQUESTED:
    case v1::HISTORY_KIND_MOTION_STARTED:
    case v1::HISTORY_KIND_MOTION_ENDED:
      return motion_text(entry, details);
    case v1::HISTORY_KIND_STOP_REQUESTED:
      return stop_text(details);
    case v1::HISTORY_KIND_STOP_ENDED:
      return stop_end_text(details);
    case v1::HISTORY_KIND_EMERGENCY_LATCHED:
      return "latched by an emergency stop: nothing moves until it is cleared";
    case v1::HISTORY_KIND_EMERGENCY_CLEARED:
      return "emergency stop cleared";
    case v1::HISTORY_KIND_LINK_CHANGED:
      return "link " + details.value("link", "?") + because;
    case v1::HISTORY_KIND_BARRIER_ENTERED:
      return "replies could not be trusted" + because;
    case v1::HISTORY_KIND_FOREIGN_MOTION:
      return axes_text(details) + " moved, and nobody here requested it";
    case v1::HISTORY_KIND_CONDITION_CHANGED:
      return change_text(details);
    case v1::HISTORY_KIND_SWITCHES_CHANGED:
      return "memory switches changed";
    case v1::HISTORY_KIND_LINES_EXCHANGED:
      return lines_text(entry, details);
    case v1::HISTORY_KIND_LEASE_GRANTED:
    case v1::HISTORY_KIND_LEASE_ENDED:
      return lease_text(entry, details);
    case v1::HISTORY_KIND_LATCHED:
      return fmt::format("{} is held back from {} until they rearm", entry.caller().name(), axes_text(details));
    case v1::HISTORY_KIND_REARMED:
      return fmt::format("{} rearmed {}", entry.caller().name(), axes_text(details));
    case v1::HISTORY_KIND_JOB_CHANGED:
      return job_entry_text(details, because);
    default:
      return fmt::format("kind {}: {}", static_cast<int>(entry.kind()), entry.details());
  }
}

// Reports whether the text of an entry of this kind already contains the caller.
bool names_caller(v1::HistoryKind kind) {
  return kind >= v1::HISTORY_KIND_LEASE_GRANTED && kind <= v1::HISTORY_KIND_REARMED;
}

}  // namespace

std::string line_of(const v1::HistoryEntry& entry) {
  std::string line = time_text(entry.time());
  if (!entry.device().empty()) line += fmt::format("  {}", last_part(entry.device()));
  line += "  " + text_of(entry);
  return entry.caller().name().empty() || names_caller(entry.kind()) ? line : line + ", by " + entry.caller().name();
}

std::vector<std::string> exchanges_of(const v1::HistoryEntry& entry) {
  std::vector<std::string> all;
  const Json details = Json::parse(entry.details(), nullptr, false);
  if (!details.is_object()) return all;
  for (const Json& exchange : lines_in(details)) {
    const std::string at = exchange.size() > 2 ? "  " + elapsed_text(exchange.at(2)) : "";
    all.push_back("  " + exchange_text(exchange) + at);
  }
  return all;
}

std::string life_text(std::uint64_t number, const std::vector<v1::HistoryEntry>& entries) {
  const auto newest = [&](v1::HistoryKind kind) {
    const auto found =
        std::find_if(entries.rbegin(), entries.rend(), [&](const auto& one) { return one.kind() == kind; });
    return found == entries.rend() ? nullptr : &*found;
  };
  if (entries.empty()) return fmt::format("the journal has no motion {}", number);
  const v1::HistoryEntry* const ended = newest(v1::HISTORY_KIND_MOTION_ENDED);
  const v1::HistoryEntry* const started = newest(v1::HISTORY_KIND_MOTION_STARTED);
  if (ended == nullptr) {
    return fmt::format("motion {} has no outcome: it has not ended, or the daemon was killed before", number);
  }
  const Json details = Json::parse(ended->details(), nullptr, false);
  if (!details.is_object()) return fmt::format("motion {}: {}", number, ended->details());
  const std::string when =
      started == nullptr ? "before it started" : duration_text(started->time(), ended->time()) + " after its start";
  return fmt::format("motion {}: {} {}{}", number, details.value("outcome", "?"), when, results_text(details));
}

std::string record_text(const v1::HistoryEntry& requested, std::chrono::seconds at) {
  return fmt::format(
      "the recording still has it, from about {} s on: axisctl --device {} record --no-follow --output "
      "motion-{}.recording",
      at.count(), last_part(requested.device()), last_part(requested.motion()));
}

}  // namespace axisgate::axisctl
