#include "device/rml1/sending/cut_places.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {
namespace {

bool ends_command(char c) { return is_delimiter(c) && !is_blank(c); }

// Returns how many numbers make a set of the command whose name, in capitals, `name` ends with; 0 if that command takes
// no list (guideline 5-1).
std::size_t set_of(std::string_view name) {
  struct Row {
    std::string_view name;
    std::size_t numbers;
  };
  // Longer names come first.
  constexpr std::array kRows{Row{"!ZZ", 3}, Row{"PA", 2}, Row{"PR", 2}, Row{"PU", 2}, Row{"PD", 2},
                             Row{"D", 2},   Row{"M", 2},  Row{"I", 2},  Row{"R", 2},  Row{"Z", 3}};
  const auto row = std::ranges::find_if(kRows, [&](const Row& one) { return name.ends_with(one.name); });
  return row == kRows.end() ? 0 : row->numbers;
}

}  // namespace

bool SetReader::take(char c) {
  if (is_letter(c) || c == '!' || c == '^') {
    take_name(c);
    return false;
  }
  name_.clear();
  if (begins_number(c)) {
    take_number(c);
    return false;
  }
  in_number_ = false;
  return c == ',' && numbers_ != 0 && count_ != 0 && count_ % numbers_ == 0;
}

void SetReader::take_name(char c) {
  name_ += is_letter(c) ? capital(c) : c;
  if (name_.size() > kLongestName) name_.erase(0, 1);
  numbers_ = set_of(name_);
  count_ = 0;
  in_number_ = false;
}

// Numbers without a separator between them cannot be counted reliably, so a list with such numbers is not cut.
void SetReader::take_number(char c) {
  if (!std::exchange(in_number_, true)) {
    ++count_;
    has_point_ = c == '.';
  } else if (!is_digit(c) && (c != '.' || std::exchange(has_point_, true))) {
    numbers_ = 0;
  }
}

CutPlaces::Cut CutPlaces::take(char c) {
  const bool completes_set = sets_.take(c);
  if (!is_delimiter(c)) {
    ended_ = false;
    calls_ = c == '^';
    return completes_set ? Cut::in_list : Cut::no;
  }
  if (ends_command(c)) {
    ended_ = true;
    sets_.end();
  }
  return ended_ && !calls_ ? Cut::between_commands : Cut::no;
}

}  // namespace axisgate::rml1
