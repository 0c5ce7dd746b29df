#include "device/shot/line/continuity.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "device/core/guard.h"
#include "device/shot/command/model.h"

namespace axisgate::shot {
namespace {

const std::string_view kQuestion = text(LineQuestion::line_before);

// Other programs may send commands that are not in the command table (PSET: ...). A command is a verb and its colon
// (manual 4.).
bool looks_like_command(std::string_view line) {
  const auto colon = line.find(':');
  return colon != std::string_view::npos && colon > 0 &&
         std::all_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '?' || c == '!'; });
}

}  // namespace

void Continuity::connected() {
  before_.clear();
  unproven_.clear();
  answered_ = true;
  refused_ = false;
  open_ = false;
  question_due_.reset();
}

void Continuity::begin(TimePoint now) {
  open_ = false;
  in_time_ = true;
  alive_ = now;
}

void Continuity::wrote(std::string_view line, Duration on_the_wire, TimePoint now) {
  // After a restart in the pause before the unanswered line, ?:CMD would report that line as well.
  if (!answered_ && !in_time_) {
    std::erase(before_, newest_);
    unproven_.push_back(newest_);
  }
  newest_ = line;
  due_ = now + on_the_wire;
  if (newest_ == kQuestion && !question_due_) question_due_ = due_;
  answered_ = false;
  in_time_ = !due(now);
  if (in_time_) before_.push_back(newest_);
}

void Continuity::answered(bool taken, TimePoint now) {
  alive_ = now;
  answered_ = true;
  unproven_.clear();
  refused_ = !taken;
  doubt(!in_time_, due_, now);
  if (taken) {
    before_ = {newest_};
  } else if (std::ranges::find(before_, newest_) == before_.end()) {
    before_.push_back(newest_);
  }
}

void Continuity::doubt(bool strongly, TimePoint due, TimePoint now) {
  const bool late = now > due + kRestartMin && guarded(Guard::late_answers_hide_restarts);
  only_late_ = !strongly && (open_ ? only_late_ : late);
  open_ = open_ || strongly || late;
}

bool Continuity::could_be(std::string_view line) const {
  return std::ranges::find(before_, line) != before_.end() || looks_like_command(line);
}

Continuity::Verdict Continuity::compare(std::string_view line_before, TimePoint now) {
  const bool refused = std::exchange(refused_, false);
  const bool known = std::ranges::find(before_, line_before) != before_.end() || (refused && in_time_);
  const bool ours = line_before == kQuestion || std::ranges::find(unproven_, line_before) != unproven_.end();
  const bool foreign = !known && !refused && !ours && looks_like_command(line_before);
  unproven_.clear();
  alive_ = now;
  answered_ = newest_ == kQuestion;
  doubt(!known, std::exchange(question_due_, {}).value_or(due_), now);
  in_time_ = true;
  before_ = {std::string(kQuestion)};
  if (newest_ != kQuestion) before_.push_back(newest_);
  return known ? Verdict::same : foreign ? Verdict::foreign : Verdict::open;
}

}  // namespace axisgate::shot
