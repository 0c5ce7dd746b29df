// Checks for repeated requests: at every line sent and at every end of a motion, and, at the end of a seed, in the
// files and in the lines that the controller received.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "device/shot/command/axes.h"
#include "server/api/request/mutations.h"
#include "server/journal/answers.h"
#include "tests/simulation/retries.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using api::RequestKind;
using server::journal::EntryKind;
using Json = nlohmann::json;

std::string_view text_of(const Json& body, const char* key) {
  const auto found = body.find(key);
  return found == body.end() ? std::string_view() : std::string_view(found->get_ref<const std::string&>());
}

// Returns the numbers of a line such as "M:A+P501-P502".
std::vector<std::int64_t> amounts_in(std::string_view line) {
  std::vector<std::int64_t> all;
  for (std::size_t at = line.find('P', line.find(':')); at != line.npos; at = line.find('P', at + 1)) {
    all.push_back(std::strtoll(line.data() + at + 1, nullptr, 10));
  }
  return all;
}

// Returns the axes of a motion's line, from the letter after the colon.
AxisSet axes_of(std::string_view line) {
  return from_command_letter(line[line.find(':') + 1], kAllAxes).value_or(AxisSet());
}

// Reports whether the line is a setting that G: starts, including J:.
bool sets(std::string_view line) { return sets_motion(line) || line.starts_with("J:"); }

}  // namespace

Retries::Places Retries::places() {
  Places all{};
  for (int axis = 1; axis <= kAxisCount; ++axis)
    all[static_cast<std::size_t>(axis - 1)] = world_.device().position(axis);
  return all;
}

void Retries::on_news(const Event& event) {
  daemon_->on_event(event, world_.now());
  if (const auto* written = std::get_if<BytesWritten>(&event)) note(*written);
  if (const auto* change = std::get_if<MotionChanged>(&event)) note(*change);
}

void Retries::note(const BytesWritten& written) {
  come_closer_to_kill();
  const bool starts = starts_motion(written.bytes);
  if (written.motion == 0 || !(starts || sets(written.bytes))) return;
  MotionFacts& facts = motions_[written.motion];
  facts.written = true;
  if (!facts.message) return;
  const Wanted& wanted = facts.message->wanted;
  auto& all = acted_[wanted.key()].written;
  all.insert(written.motion);
  if (all.size() > 1) {
    world_.violation(fmt::format("{} of {} acts again: {} is a line of motion {}, and motion {} was its first",
                                 wanted.id, wanted.who, written.bytes.substr(0, written.bytes.find('\r')),
                                 written.motion, *all.begin()));
  }
  if (facts.message->outdated) {
    world_.violation(fmt::format("{} of {} moves under a lease of a daemon before", wanted.id, wanted.who));
  }
  // Under one interpretation of the manual an axis may start without its G:, so the motion starts from here.
  if (!facts.from) facts.from = places();
  if (starts && !std::exchange(facts.start_written, true) && world_.now() > facts.message->context.not_after) {
    world_.violation(fmt::format("{} of {} starts after its not_after", wanted.id, wanted.who));
  }
}

void Retries::note(const MotionChanged& change) {
  const Motion& motion = change.motion;
  const bool is_new = !motions_.contains(motion.id);
  MotionFacts& facts = motions_[motion.id];
  if (motion.state == MotionState::queued) {
    if (!is_new) world_.violation(fmt::format("the number {} was given to two motions", motion.id));
    facts.message = asking_;
  }
  if (daemon_->disk_hangs()) facts.may_lack_rows = true;
  if (!is_outcome(motion.state)) return;
  facts.outcome = motion.state;
  facts.ended_at = places();
  counts_.succeeded += motion.state == MotionState::succeeded ? 1 : 0;
  check_approach(motion, facts);
}

// Checks that a successful motion went the whole distance from the simulator's positions when its first line was
// written.
void Retries::check_approach(const Motion& motion, const MotionFacts& facts) {
  if (motion.state != MotionState::succeeded || !facts.message || world_.wire().damaged_since(TimePoint{})) return;
  const Wanted& wanted = facts.message->wanted;
  if (wanted.kind == RequestKind::jog) return;
  if (!facts.from) {
    return world_.violation(fmt::format("motion {} succeeded, and no line of it was written", motion.id));
  }
  const bool to_origin = wanted.kind == RequestKind::home || wanted.kind == RequestKind::return_to_origin;
  Places due = to_origin ? facts.ended_at : *facts.from;
  for (const auto& [axis, way] : wanted.ways) {
    std::int64_t& place = due[static_cast<std::size_t>(axis - 1)];
    place = to_origin ? 0 : place + way;
  }
  for (const auto& [axis, way] : wanted.ways) {
    const auto index = static_cast<std::size_t>(axis - 1);
    if (due[index] == facts.ended_at[index]) continue;
    world_.violation(fmt::format("motion {} succeeded, and axis {} is at {} instead of {}", motion.id, axis,
                                 facts.ended_at[index], due[index]));
  }
}

// Checks that all answers to one request name the same motion, and that all but one are marked as repeated.
void Retries::answered(const Wanted& wanted, MotionId motion, bool repeated) {
  Acted& acted = acted_[wanted.key()];
  if (acted.motion && *acted.motion != motion) {
    world_.violation(fmt::format("{} of {} was answered with motion {}, and before with motion {}", wanted.id,
                                 wanted.who, motion, *acted.motion));
  }
  acted.motion = motion;
  acted.firsts += repeated ? 0 : 1;
  if (acted.firsts > 1) world_.violation(fmt::format("{} of {} was done twice", wanted.id, wanted.who));
}

// Checks an answer to Execute. A kill may lose the answer, which is then unknown.
void Retries::check_answer(const Wanted& wanted, const std::string& answer) {
  std::string& before = acted_[wanted.key()].answer;
  const auto problem = server::journal::problem_in(answer);
  const bool is_lost = problem && problem->reason == Reason::outcome_unknown;
  if (!before.empty() && !is_lost && before != answer) {
    world_.violation(fmt::format("{} of {} was answered {}, and before {}", wanted.id, wanted.who, answer, before));
  }
  if (!is_lost) before = answer;
}

void Retries::check_journal() {
  const auto& journal = daemon_->journal();
  const auto verdict = journal.verify({});
  if (!verdict || verdict->first_bad) world_.violation("the chain of the journal does not verify");
  const auto rows = journal.read({.oldest_first = true}, 1'000'000);
  if (!rows) return world_.violation(rows.error().message);
  std::map<MotionId, int> last_kinds;
  for (const auto& row : *rows) {
    if (row.entry.motion != 0) check_row(row, last_kinds);
  }
  for (const auto& [id, facts] : motions_) {
    const auto found = last_kinds.find(id);
    const bool ended = found != last_kinds.end() && found->second == static_cast<int>(EntryKind::motion_ended);
    const bool may_lack_it = facts.may_lack_rows && found == last_kinds.end();
    if (!ended && !may_lack_it) world_.violation(fmt::format("motion {} has no end in the journal", id));
  }
}

// Checks that the rows of a motion come in the order of their kinds: requested, started, ended.
void Retries::check_row(const server::journal::StoredEntry& row, std::map<MotionId, int>& last_kinds) {
  const auto found = motions_.find(row.entry.motion);
  if (found == motions_.end()) {
    return world_.violation(fmt::format("row {} is of motion {}, which there was not", row.number, row.entry.motion));
  }
  const MotionFacts& facts = found->second;
  if (row.entry.kind == EntryKind::request_refused && facts.written) {
    world_.violation(fmt::format("row {} refuses motion {}, of which a line was written", row.number, found->first));
  }
  const bool of_motion = row.entry.kind == EntryKind::motion_requested || row.entry.kind == EntryKind::motion_started ||
                         row.entry.kind == EntryKind::motion_ended;
  if (!of_motion) return;
  int& last = last_kinds[found->first];
  const int kind = static_cast<int>(row.entry.kind);
  if (last >= kind || (last == 0 && row.entry.kind != EntryKind::motion_requested)) {
    world_.violation(fmt::format("row {} of motion {} is a {}, out of order", row.number, found->first,
                                 server::journal::name(row.entry.kind)));
  }
  last = kind;
  if (row.entry.kind == EntryKind::motion_ended) check_end(row, facts);
}

void Retries::check_end(const server::journal::StoredEntry& row, const MotionFacts& facts) {
  const Json body = Json::parse(row.entry.body);
  const auto wrong = [&](std::string_view what) {
    world_.violation(
        fmt::format("row {}, the end of motion {}, {}: {}", row.number, row.entry.motion, what, row.entry.body));
  };
  const bool succeeded = text_of(body, "outcome") == name(MotionState::succeeded);
  if (succeeded && facts.outcome != MotionState::succeeded) wrong("is better than the truth");
  counts_.unknown += text_of(body, "outcome") == name(MotionState::unknown) ? 1 : 0;
  if (text_of(body, "reason") == name(Reason::not_sent)) {
    ++counts_.never_sent;
    // A row without results was written by the daemon after the kill. With results, the controller itself may have set
    // the axis and seen that the start was not received.
    if (facts.written && !body.contains("results")) wrong("denies a line that was written");
    if (facts.written && was_started(facts)) wrong("denies a start that arrived");
  }
  if (!succeeded || world_.wire().damaged_since(TimePoint{})) return;
  for (const Json& result : body.value("results", Json::array())) {
    const auto place = facts.ended_at[result["axis"].get<std::size_t>() - 1];
    if (result.value("target_pulses", place) != place || result.value("command_pulses", place) != place) {
      wrong(fmt::format("has another place than the simulator, {}", place));
    }
  }
}

// Checks that exactly the requests open in memory are open on file, and that each answered request has its motion on
// file.
void Retries::check_requests_on_file() {
  auto store = server::journal::Store::open_to_read(folder_.journal());
  const auto on_file = store ? store->requests() : tl::unexpected(store.error());
  if (!on_file) return world_.violation(on_file.error().message);
  std::set<Key> open;
  for (const auto& request : daemon_->requests().open()) open.insert({request.identity, request.id});
  for (const auto& request : on_file->requests) {
    const Key key{request.identity, request.id};
    if (request.open != (open.erase(key) > 0)) {
      world_.violation(fmt::format("{} of {} is open in the memory or on file alone", request.id, request.identity));
    }
    const Acted& acted = acted_[key];
    if (acted.motion && *acted.motion != request.motion) {
      world_.violation(fmt::format("{} of {} is on file with motion {}, and was answered with {}", request.id,
                                   request.identity, request.motion, *acted.motion));
    }
  }
  for (const auto& [identity, id] : open) world_.violation(fmt::format("{} of {} is not on file", id, identity));
}

// Checks in the lines that the controller received that no displacement was set and then started twice. Each
// displacement is unique.
void Retries::check_received() {
  if (world_.wire().commands_damaged() > 0) return;
  std::map<int, std::int64_t> set;
  for (const std::string& line : world_.device().received()) {
    if (!sets(line) && !line.starts_with("G:")) continue;
    const std::vector<std::int64_t> amounts = sets_motion(line) ? amounts_in(line) : std::vector<std::int64_t>();
    std::size_t index = 0;
    for (const int axis : axes_of(line).list()) {
      if (sets(line)) {
        set[axis] = index < amounts.size() ? amounts[index++] : 0;
      } else if (const auto started = set.extract(axis);
                 started && started.mapped() != 0 && !started_.insert(started.mapped()).second) {
        world_.violation(fmt::format("the controller was started twice for a way of {} pulses", started.mapped()));
      }
    }
  }
  check_starts();
}

bool Retries::was_started(const MotionFacts& facts) const {
  return facts.message && std::ranges::any_of(facts.message->wanted.ways, [this](const auto& one) {
           return started_.contains(std::abs(one.second));
         });
}

// Checks that the controller has started an axis at most once for each displacement sent.
void Retries::check_starts() {
  std::array<int, kAxisCount> starts{};
  for (const auto& [id, facts] : motions_) {
    if (!facts.written || !facts.message) continue;
    for (const auto& [axis, way] : facts.message->wanted.ways) ++starts[static_cast<std::size_t>(axis - 1)];
  }
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    const int allowed = starts[static_cast<std::size_t>(axis - 1)];
    if (world_.device().starts(axis) <= allowed) continue;
    world_.violation(
        fmt::format("axis {} was set in motion {} times, for {} ways", axis, world_.device().starts(axis), allowed));
  }
}

}  // namespace axisgate::simulation
