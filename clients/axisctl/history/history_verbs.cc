// history, audit: shows what has happened, verifies the journal, and erases a name from the journal.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/gateway/kept_recording.h"
#include "clients/axisctl/history/history_csv.h"
#include "clients/axisctl/history/history_reader.h"
#include "clients/axisctl/history/history_text.h"
#include "clients/axisctl/history/night.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

using google::protobuf::util::TimeUtil;

// Deadline of calls that read the whole journal.
constexpr std::chrono::seconds kJournalLimit{600};

// Converts the value of --outcome, such as "failed"; UNSPECIFIED if it is empty.
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

// Returns "EPOCH:NUMBER:HASH", one line to note down.
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

// Returns the text for damage outside the entries. `fault` is SQLite's message.
std::string damage_text(const std::string& fault) {
  return "the file is damaged elsewhere, mostly in an index, so that `axisctl history` may lack entries: " + fault +
         " (to make the indices again, end the daemon and type `sqlite3 journal.sqlite REINDEX` in its state "
         "directory)";
}

// Prints the summary of one motion from its entries, oldest first, and the command for its recording if the daemon
// still has it.
void print_life(const Session& session, const std::vector<v1::HistoryEntry>& entries) {
  print_line(life_text(*session.options.motion, entries));
  if (entries.empty()) return;
  const auto at = place_in_recording(session, entries.front().device(), entries.front().time());
  if (at) print_line(record_text(entries.front(), *at));
}

}  // namespace

int history(const Session& session) {
  const Options& options = session.options;
  if (options.night) return show_night(session);
  const v1::ListHistoryRequest request = request_of(session);
  std::vector<v1::HistoryEntry> life;
  const auto show = [&](const v1::HistoryEntry& entry) {
    if (options.json) return print_json(entry);
    if (options.csv) return print_line(csv_row(entry));
    print_line(line_of(entry));
    if (!options.motion) return;
    for (const std::string& exchanged : exchanges_of(entry)) print_line(exchanged);
    life.push_back(entry);
  };
  if (options.csv) print_line(kCsvHeader);
  if (options.follow) follow_history(session, request, show);
  list_history(session, request, show);
  if (options.motion && !options.json && !options.csv) print_life(session, life);
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
    if (!verdict.fault().empty()) print_line(damage_text(verdict.fault()));
    print_line("head " + head_text(verdict.head()));
  } else {
    print_line(fmt::format("entry {}: {}", verdict.first_bad(), verdict.fault()));
  }
  return verdict.first_bad() == 0 && verdict.fault().empty() ? kDone : kFailed;
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
