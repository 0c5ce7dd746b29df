// history, audit: what has happened, whether the journal is as it was written, and erasing a name from it.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/history_csv.h"
#include "clients/axisctl/history_reader.h"
#include "clients/axisctl/night.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

using google::protobuf::util::TimeUtil;
using Json = nlohmann::json;

// All of a journal is read.
constexpr std::chrono::seconds kJournalLimit{600};

std::string axes_text(const Json& details) {
  std::string text;
  for (const Json& axis : details.value("axes", Json::array())) {
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
      return fmt::format("refused: {}, {}", details.value("request", "a request"), details.value("reason", "?"));
    case v1::HISTORY_KIND_REQUEST_ENDED:
      return fmt::format("{}: {}", details.value("request", "a request"), details.value("outcome", "?"));
    case v1::HISTORY_KIND_PERSON_ERASED:
      return fmt::format("the name of caller {} was erased", details.value("person", std::int64_t{}));
    case v1::HISTORY_KIND_MOTION_REQUESTED:
    case v1::HISTORY_KIND_MOTION_STARTED:
    case v1::HISTORY_KIND_MOTION_ENDED:
      return motion_text(entry, details);
    case v1::HISTORY_KIND_STOP_REQUESTED:
      return fmt::format("{} of {}", details.value("emergency", false) ? "emergency stop" : "stop", axes_text(details));
    case v1::HISTORY_KIND_LINK_CHANGED:
      return "link " + details.value("link", "?") + because;
    case v1::HISTORY_KIND_BARRIER_ENTERED:
      return "replies could not be trusted" + because;
    case v1::HISTORY_KIND_FOREIGN_MOTION:
      return axes_text(details) + " moved, and nobody here requested it";
    case v1::HISTORY_KIND_SWITCHES_CHANGED:
      return "memory switches changed";
    default:
      return fmt::format("kind {}: {}", static_cast<int>(entry.kind()), entry.details());
  }
}

std::string line_of(const v1::HistoryEntry& entry) {
  std::string line = time_text(entry.time());
  if (!entry.device().empty()) line += fmt::format("  {}", last_part(entry.device()));
  line += "  " + text_of(entry);
  return entry.who().empty() ? line : line + ", by " + entry.who();
}

// When it ended and where; after its entries, oldest first.
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

// "failed" as an option has it; empty: none.
v1::MotionState outcome_of(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  v1::MotionState outcome = v1::MOTION_STATE_UNSPECIFIED;
  v1::MotionState_Parse("MOTION_STATE_" + text, &outcome);
  return outcome;
}

v1::ListHistoryRequest request_of(const Session& session) {
  const Options& options = session.options;
  v1::ListHistoryRequest request;
  request.set_device(options.device);
  request.set_who(options.who);
  if (options.motion) {
    request.set_motion(fmt::format("{}/motions/{}", chosen_device(session).name(), *options.motion));
    request.set_order(v1::ListHistoryRequest::ORDER_OLDEST_FIRST);
  }
  if (!options.axis.empty()) {
    const v1::Device device = chosen_device(session);
    request.set_device(device.name());
    request.set_axis(find_axis(device, options.axis).number());
  }
  request.set_outcome(outcome_of(options.outcome));
  request.set_text(options.text);
  if (options.hours)
    *request.mutable_start_time() = TimeUtil::SecondsToTimestamp(std::time(nullptr) - *options.hours * 3600L);
  return request;
}

std::string hex(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

// "EPOCH:NUMBER:HASH", on a line that can be kept.
std::string head_text(const v1::JournalHead& head) {
  return fmt::format("{}:{}:{}", head.epoch(), head.number(), hex(head.hash()));
}

v1::JournalHead head_of(const std::string& text) {
  const Failure wrong =
      usage("'" + text + "' is no head of a journal", "give one as `axisctl audit verify` printed it");
  const auto first = text.find(':'), second = text.find(':', first + 1);
  if (second == std::string::npos) throw wrong;
  v1::JournalHead head;
  head.set_epoch(text.substr(0, first));
  std::int64_t number = 0;
  if (std::from_chars(text.data() + first + 1, text.data() + second, number).ptr != text.data() + second) throw wrong;
  head.set_number(number);
  for (std::size_t at = second + 1; at < text.size(); at += 2) {
    unsigned byte = 0;
    const char* const end = text.data() + std::min(at + 2, text.size());
    if (std::from_chars(text.data() + at, end, byte, 16).ptr != end) throw wrong;
    head.mutable_hash()->push_back(static_cast<char>(byte));
  }
  return head;
}

}  // namespace

int history(const Session& session) {
  const Options& options = session.options;
  if (options.night) return show_night(session);
  const v1::ListHistoryRequest request = request_of(session);
  std::vector<v1::HistoryEntry> life;
  const auto show = [&](const v1::HistoryEntry& entry) {
    if (options.json) return print_json(entry);
    print_line(options.csv ? csv_row(entry) : line_of(entry));
    if (options.motion) life.push_back(entry);
  };
  if (options.csv) print_line(kCsvHeader);
  if (options.follow) follow_history(session, request, show);
  list_history(session, request, show);
  if (options.motion && !options.json && !options.csv) print_line(life_text(*options.motion, life));
  return kDone;
}

int audit_verify(const Session& session) {
  v1::VerifyJournalRequest request;
  if (!session.options.head.empty()) *request.mutable_noted() = head_of(session.options.head);
  const v1::VerifyJournalResponse verdict = session.connection.call(
      session.connection.history, &v1::HistoryService::Stub::VerifyJournal, request, kJournalLimit);
  if (session.options.json) {
    print_json(verdict);
  } else if (verdict.first_bad() == 0) {
    print_line(fmt::format("{} entries are as they were written", verdict.good()));
    print_line("head " + head_text(verdict.head()));
  } else {
    print_line(fmt::format("entry {}: {}", verdict.first_bad(), verdict.fault()));
  }
  return verdict.first_bad() == 0 ? kDone : kFailed;
}

int audit_erase(const Session& session) {
  const std::string& who = session.options.who;
  if (!session.options.yes)
    throw usage("nothing was erased: nothing could bring the name back", "to erase it, add --yes");
  v1::ErasePersonRequest request;
  request.set_who(who);
  const v1::ErasePersonResponse erased = session.connection.call(
      session.connection.history, &v1::HistoryService::Stub::ErasePerson, request, kJournalLimit);
  if (session.options.json) {
    print_json(erased);
    return kDone;
  }
  print_line(fmt::format("{} is now \"{}\"; entries: {}", who, erased.erased_as(), erased.entries()));
  if (erased.requests() > 0) {
    print_line(fmt::format("remembered requests that have the name until they are forgotten: {}", erased.requests()));
  }
  print_line("other files may have the name: `axisctl help audit` lists them");
  return kDone;
}

}  // namespace axisgate::axisctl
