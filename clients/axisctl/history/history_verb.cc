// history: shows what has happened.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <ctime>
#include <string>
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
  request.set_caller(options.who);
  if (options.motion) {
    request.set_motion(fmt::format("{}/motions/{}", chosen_device(session).name(), *options.motion));
    request.set_order(v1::ListHistoryRequest::ORDER_OLDEST_FIRST);
  }
  if (!options.axis.empty()) {
    const v1::Device device = chosen_device(session);
    request.set_device(device.name());
    request.set_axis(std::to_string(find_axis(device, options.axis).number()));
  }
  request.set_outcome(outcome_of(options.outcome));
  request.set_text(options.text);
  if (options.hours)
    *request.mutable_start_time() = TimeUtil::SecondsToTimestamp(std::time(nullptr) - *options.hours * 3600L);
  return request;
}

// Prints the summary of one motion from its entries, oldest first, and the command for its recording if the daemon
// still keeps it.
void print_life(const Session& session, const std::vector<v1::HistoryEntry>& entries) {
  print_line(life_text(*session.options.motion, entries));
  if (entries.empty()) return;
  const auto at = place_in_recording(session, entries.front().device(), entries.front().time());
  if (at) print_line(record_text(entries.front(), *at));
}

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

void history_options(CLI::App& verb, Options& options) {
  CLI::Option* hours = verb.add_option("--hours", options.hours, "only the last N hours");
  hours->check(CLI::Range(1, 100'000))->type_name("N");
  CLI::Option* who = verb.add_option("--who", options.who, "only what this caller did, e.g. 'unix anna'");
  CLI::Option* motion =
      verb.add_option("--motion", options.motion, "only the motion with this number, oldest first, and how it ended");
  CLI::Option* axis = verb.add_option("--axis", options.axis, "only what names this axis: a number or a name");
  CLI::Option* outcome = verb.add_option("--outcome", options.outcome, "only motions that ended so")
                             ->check(CLI::IsMember({"succeeded", "stopped", "failed", "unknown"}));
  CLI::Option* text = verb.add_option("--text", options.text, "only entries with this text in their details");
  CLI::Option* limit = verb.add_option("--limit", options.limit, "at most N entries");
  limit->check(CLI::Range(1, 1'000'000))->capture_default_str();
  CLI::Option* follow = verb.add_flag("--follow", options.follow, "oldest first, then each new entry, until Ctrl-C");
  CLI::Option* csv = verb.add_flag("--csv", options.csv, "as a table for other programs, times in UTC");
  CLI::Option* night = verb.add_flag("--night", options.night,
                                     "who moved what, and what went wrong, since 18:00 yesterday or in --hours N");
  who->type_name("WHO");
  motion->type_name("NUMBER");
  axis->type_name("AXIS");
  outcome->type_name("OUTCOME");
  text->type_name("TEXT");
  limit->type_name("N");
  for (CLI::Option* other : {who, motion, axis, outcome, text, limit, follow, csv}) night->excludes(other);
  // These options would hide the entry with the motion's outcome.
  for (CLI::Option* other : {hours, who, axis, outcome, text, limit, follow}) motion->excludes(other);
  csv->excludes(verb.get_parent()->get_option("--json"));
}

constexpr Verb kHistoryVerbs[] = {
    {.words = "history",
     .heading = Heading::looking,
     .description = "show what has happened, newest first",
     .help =
         R"(The daemon keeps it in its state directory, also over restarts. --night sums up who moved what, who stopped what, when a
link was lost, and when the daemon started. The conditions of the other options must all be fulfilled. Details are those
of --json; in --text capital and small letters differ. --motion also shows the lines that were sent, with their answers,
and how to get the recording around them while the daemon has it. `others_seen_by` in the configuration may let you read
only your own entries; a note says so.)",
     .examples = R"(axisctl history --night
axisctl history --hours 12 --axis 1 --outcome failed
axisctl history --who 'unix anna' --limit 20
axisctl history --text LIMIT_DETECTED
axisctl history --motion 1
axisctl history --hours 12 --limit 100000 --csv
axisctl history --follow   # until Ctrl-C)",
     .add_options = history_options,
     .run = history},
};

}  // namespace

std::span<const Verb> history_verbs() { return kHistoryVerbs; }

}  // namespace axisgate::axisctl
