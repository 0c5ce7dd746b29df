#include "tests/rml1/executed_job.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "tests/rml1/mill.h"

namespace axisgate::rml1 {
namespace {

constexpr double kOnTheWay = 1e-3;  // steps; tolerance for a place on the path

std::optional<std::size_t> buffered_in(std::string_view line) {
  constexpr std::string_view kKey = "\"buffered\":";
  const auto at = line.find(kKey);
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t number = 0;
  std::from_chars(line.data() + at + kKey.size(), line.data() + line.size(), number);
  return number;
}

double distance(const simulator::Position& a, const simulator::Position& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.h - b.h);
}

std::string event_text(const Course::Event& event) {
  std::ostringstream out;
  PrintTo(event, &out);
  return out.str();
}

}  // namespace

ExecutedJob::ExecutedJob(const std::string& text, const Profile& profile)
    : course_(course_of_model(text, profile).events),
      tool_{std::round(profile.steps(kWork.x)), std::round(profile.steps(kWork.y)), 0} {}

void ExecutedJob::receives(char byte, std::uint64_t through) {
  bytes_.push_back({byte, through});
  if (through > 0) received_ = through;
}

void ExecutedJob::changed(std::uint64_t through) {
  if (!same_through_) same_through_ = through - 1;
}

void ExecutedJob::recorded(const std::string& line) {
  if (line.find("\"error\":16") != std::string::npos) {
    lost(bytes_.back().through);
    bytes_.pop_back();
  } else if (const auto buffered = buffered_in(line)) {
    begins(*buffered);
  } else if (const auto event = recorded_event(line)) {
    if (of_job_ && compared_) happened(*event);
  }
}

// Handles a byte that was lost because the mill's buffer was full.
void ExecutedJob::lost(std::uint64_t through) {
  if (through == 0) return;
  if (!same_through_ && !may_overflow_) violate("a byte of the job found the mill's buffer full");
  changed(through);
}

// Returns the number of bytes of an unfinished escape. They are not in the buffer and have had no effect yet.
std::size_t ExecutedJob::unfinished_escape() const {
  constexpr char kEscape = '\x1B';
  const std::size_t size = bytes_.size();
  if (size > 0 && bytes_[size - 1].value == kEscape) return 1;
  return size > 1 && bytes_[size - 1].value == '.' && bytes_[size - 2].value == kEscape ? 2 : 0;
}

// Notes that a command begins. Each received byte is buffered, lost, or read.
void ExecutedJob::begins(std::size_t buffered) {
  const std::uint64_t through = bytes_.at(bytes_.size() - unfinished_escape() - buffered - 1).through;
  of_job_ = through > 0;
  other_begun_ = other_begun_ || (!of_job_ && begun_ > 0);
  if (!of_job_) return;
  if (other_begun_) violate(fmt::format("after the abort, byte {} of the job is executed", through));
  begun_before_ = std::exchange(begun_, through);
  compared_ = compared_ && (!same_through_ || through <= *same_through_);
}

void ExecutedJob::happened(const Course::Event& event) {
  if (next_ == course_.size()) return violate(fmt::format("after all of the job, {}", event_text(event)));
  if (ended_) return violate(fmt::format("after ESC.K, {}", event_text(event)));
  const Course::Event& expected = course_[next_];
  if (event == expected) {
    ++next_;
  } else if (bytes_.back().through == 0 && is_part_of(event)) {
    ended_ = true;
  } else {
    return violate(fmt::format("event {} is {} instead of {}", next_, event_text(event), event_text(expected)));
  }
  if (event.kind == Course::Event::Kind::moved) tool_ = event.to;
}

// Reports whether the event is a part of the expected movement: ESC.K ends a movement in progress (guideline 4-2).
bool ExecutedJob::is_part_of(const Course::Event& event) const {
  const Course::Event& expected = course_[next_];
  using Kind = Course::Event::Kind;
  if (event.kind != Kind::moved || expected.kind != Kind::moved) return false;
  const double detour = distance(tool_, event.to) + distance(event.to, expected.to) - distance(tool_, expected.to);
  return detour <= kOnTheWay;
}

void ExecutedJob::violate(std::string what) {
  if (!violation_) violation_ = std::move(what);
}

}  // namespace axisgate::rml1
