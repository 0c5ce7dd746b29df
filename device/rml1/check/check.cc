#include "device/rml1/check/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "device/rml1/check/known_file.h"

namespace axisgate::rml1 {
namespace {

// Returns a text such as "12 s", "3 min 5 s" or "2 h 10 min".
std::string duration(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace

std::string time_text(const Summary& summary) {
  return duration(summary.seconds_low) + " to " + duration(summary.seconds_high);
}

std::string time_reason(const Summary& summary, const Profile& profile) {
  const Acceleration& assumed = profile.acceleration;
  std::string text = fmt::format(
      "at full speed throughout, or by a mill that stops at each point ({:g} mm/s2 are "
      "assumed) or is {:.0f} % slower",
      assumed.worst, assumed.slower * 100);
  if (summary.seconds_down > 0) {
    text += fmt::format("; the longer time has {} for the way down from the top to Z0, which may lie anywhere",
                        duration(summary.seconds_down));
  }
  return text;
}

Check::Check(const Profile& profile, CheckOptions options, MoveListener* moves)
    : profile_(profile),
      options_(std::move(options)),
      moves_(moves),
      machine_(profile, options_.origin, diagnostics_, *this),
      parser_(profile.dialect, diagnostics_, *this),
      judge_(profile, options_.origin.has_value(), options_.stock, options_.others, diagnostics_),
      profile_judge_(profile, options_.others, options_.made_for, diagnostics_),
      state_judge_(profile, diagnostics_),
      workload_(profile, options_.tool_mm) {}

bool Check::is_other_file() const {
  return opening_.verdict() == Opening::Verdict::g_code || opening_.verdict() == Opening::Verdict::other_file;
}

void Check::feed(std::string_view bytes) {
  bytes_ += bytes.size();
  if (opening_.verdict() == Opening::Verdict::nothing_yet) {
    bytes.remove_prefix(opening_.take(bytes));
    judge_opening();
  }
  if (opening_.verdict() == Opening::Verdict::job) parser_.feed(bytes);
}

// Judges the opening once, when the kind of file is known.
void Check::judge_opening() {
  switch (opening_.verdict()) {
    case Opening::Verdict::nothing_yet:
      return;
    case Opening::Verdict::job:
      return begin_job();
    case Opening::Verdict::g_code:
      diagnostics_.error(0, opening_.g_code_place(), "1-2", [] {
        return "this is G-code, not RML-1: a machine that expects RML-1 may hang until it is switched off";
      });
      return;
    case Opening::Verdict::other_file:
      diagnostics_.error(0, {}, "1-2",
                         [this] { return fmt::format("this is {}, not a job in RML-1", opening_.what()); });
  }
}

void Check::begin_job() {
  std::string_view bytes = opening_.held();
  profile_judge_.begins(bytes.substr(0, kHead));
  if (bytes.starts_with(kByteOrderMark)) {
    diagnostics_.error(1, {}, "1-1", [] {
      return "the file begins with a byte order mark, EF BB BF, which is no part of RML-1: save it as ASCII";
    });
    bytes.remove_prefix(kByteOrderMark.size());
    parser_.skip(kByteOrderMark.size());
  }
  parser_.feed(bytes);
}

void Check::finish() {
  if (opening_.verdict() == Opening::Verdict::nothing_yet) {
    opening_.finish();
    judge_opening();
  }
  if (!is_other_file()) {
    parser_.finish();
    judge_.finish(machine_, parser_.commands());
    profile_judge_.finish(extent());
    state_judge_.finish(machine_);
    report_no_command();
  }
  summary_.final = machine_.tool();
  summary_.commands = parser_.commands();
}

jobs::Extent Check::extent() const { return jobs::scaled({summary_.bounds, summary_.cut}, profile_.step_mm); }

void Check::report_no_command() {
  if (parser_.commands() > 0 || diagnostics_.count(Severity::error) > 0) return;
  diagnostics_.error(0, {}, "1-2", [this] {
    return bytes_ == 0 ? std::string("the file is empty: this is no job")
                       : fmt::format("{} bytes without a command: this is no job", bytes_);
  });
}

void Check::execute(const Instruction& instruction) {
  machine_.execute(instruction);
  profile_judge_.executed(instruction);
  state_judge_.executed(instruction);
}

// Each byte takes ten bits: eight of data, a start bit and a stop bit.
double Check::arrival(std::uint64_t end) const {
  return profile_.baud ? static_cast<double>(end) * 10 / *profile_.baud : 0;
}

void Check::moved(const Move& move) {
  const jobs::Point way = (move.to - move.from) * profile_.step_mm;
  // The descent from the height where the tool is when a job begins says nothing about the job.
  const bool first_height = !moved_ && way.x == 0 && way.y == 0;
  moved_ = true;
  summary_.distance_mm += length(way);
  summary_.cutting_mm += length(way) * move.cutting_part();
  if (move.cuts() && move.turning) summary_.rpm.take(machine_.rpm());
  summary_.bounds.take(first_height ? move.to : move.from);
  summary_.bounds.take(move.to);
  if (move.cuts()) {
    summary_.cut.take(sunk(move.from, move.to));
    summary_.cut.take(sunk(move.to, move.from));
  }
  const StepTime time = move_time(move, profile_, options_.origin.has_value());
  if (first_height && !options_.origin) summary_.seconds_down = time.most;
  take(time, move.end);
  judge_.moved(move);
  const bool plane = move.operation == Operation::plot && (way.x != 0 || way.y != 0);
  judge_.took(workload_.moved(move, plane ? machine_.cutting_speed() : machine_.z_speed()), move);
  if (moves_ != nullptr) moves_->moved(move);
}

// Adds a step, which begins when the last byte of its command has arrived.
void Check::take(const StepTime& time, std::uint64_t end) {
  summary_.seconds_low = std::max(summary_.seconds_low, arrival(end)) + time.least;
  summary_.seconds_high = std::max(summary_.seconds_high, arrival(end)) + time.most;
}

void Check::waited(Wait what, double seconds, std::uint64_t end) {
  if (what == Wait::spin_up) ++summary_.spin_ups;
  take(wait_time(what, seconds, profile_.acceleration), end);
}

void Check::commanded(const jobs::Point& from, const jobs::Point& target, bool height_alone, const Instruction& by) {
  judge_.commanded(from, target, height_alone, machine_.box(), by);
  if (!height_alone) profile_judge_.commanded(target, by);
  if (target.z < 0) profile_judge_.deepened(target, by);
  const bool says_height = by.row->operation != Operation::plot && !machine_.relative();
  if (target.z > 0 && says_height) profile_judge_.lifted(target.z, by);
  if (!by.first && machine_.dwell_s() > 0) take(dwell_between_points(machine_.dwell_s()), by.end);
  if (moves_ == nullptr) return;
  find_left_out(machine_.box(), from, target,
                [this](const jobs::Point& a, const jobs::Point& b) { moves_->left_out(a, b); });
}

void Check::lifted(double steps, const Instruction& by) { profile_judge_.lifted(steps, by); }

}  // namespace axisgate::rml1
