#include "device/rml1/language/axes_reader.h"

#include <algorithm>

#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {
namespace {

constexpr std::string_view kSection = "3-3";

bool is_end(char c) { return c == ';' || c == '\r' || c == '\n'; }

}  // namespace

void AxesReader::begin() {
  state_ = State::letter;
  count_ = 0;
  group_ended_ = false;
}

AxesReader::Found AxesReader::take(char c, const jobs::Place& place) {
  if (state_ == State::number) {
    if (number_.take(c)) return Found::nothing;
    end_number();
  }
  if (state_ == State::skip) return is_end(c) ? Found::end : Found::nothing;
  if (is_blank(c)) return Found::nothing;
  if (state_ == State::value) {
    if (begins_number(c)) {
      number_.begin(c);
      number_place_ = place;
      state_ = State::number;
      return Found::nothing;
    }
    fail(3, target_.place, "an axis without a number: this group and all after it are skipped");
    return is_end(c) ? Found::end : Found::nothing;
  }
  return letter(c, place);
}

AxesReader::Found AxesReader::letter(char c, const jobs::Place& place) {
  if (group_ended_) count_ = 0;
  group_ended_ = false;
  if (c == ':' || is_end(c)) {
    group_ended_ = true;
    if (count_ > 0) return c == ':' ? Found::group : Found::last;
    return c == ':' ? Found::nothing : Found::end;
  }
  if (is_letter(c)) {
    target_ = {.letter = capital(c), .value = 0, .point = false, .place = place};
    state_ = State::value;
    const auto same = [this](const AxisTarget& target) { return target.letter == target_.letter; };
    if (std::any_of(targets_.begin(), targets_.begin() + static_cast<std::ptrdiff_t>(count_), same)) {
      fail(2, place, "an axis is named twice in one group: this group and all after it are skipped");
    } else if (move_apart(target_.letter)) {
      fail(3, place, "axes that this machine cannot move at once: this group and all after it are skipped");
    }
    return Found::nothing;
  }
  fail(3, place,
       begins_number(c) ? "a number without an axis: this group and all after it are skipped"
                        : "no letter of an axis: this group and all after it are skipped");
  return Found::nothing;
}

void AxesReader::end_number() {
  if (number_.sign_alone()) {
    fail(3, target_.place, "an axis without a number: this group and all after it are skipped");
    return;
  }
  const double value = number_.value();
  target_.value = std::clamp(value, kLongLowest, kLongHighest);
  target_.point = number_.has_point();
  if (target_.value != value) {
    diagnostics_.warn(Warning::out_of_range, number_place_, "2-5",
                      [] { return "a number beyond its type's range: the nearest in it is taken"; });
  }
  targets_[count_++] = target_;
  state_ = State::letter;
}

void AxesReader::fail(int number, const jobs::Place& place, std::string_view why) {
  diagnostics_.error(number, place, kSection, [why] { return why; });
  state_ = State::skip;
}

bool AxesReader::move_apart(char letter) const {
  for (std::size_t index = 0; index < count_; ++index) {
    const char other = targets_[index].letter;
    const auto names_both = [&](const std::string& pair) {
      return pair.find(letter) != std::string::npos && pair.find(other) != std::string::npos;
    };
    if (std::any_of(apart_.begin(), apart_.end(), names_both)) return true;
  }
  return false;
}

}  // namespace axisgate::rml1
