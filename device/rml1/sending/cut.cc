#include "device/rml1/sending/cut.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "device/rml1/characters.h"

namespace axisgate::rml1 {
namespace {

bool is_between_commands(char c) { return c == ';' || static_cast<unsigned char>(c) <= ' '; }
bool ends_command(char c) { return is_between_commands(c) && c != ' ' && c != '\t'; }

// A circumflex waits for the next command, across delimiters (guideline 1-2).
bool calls(std::string_view command) {
  const auto last = std::ranges::find_if_not(command.rbegin(), command.rend(), is_between_commands);
  return last != command.rend() && *last == '^';
}

// How many numbers make a set of the command that this ends with, in capitals; 0: it takes no list of sets (guideline
// 5-1).
std::size_t set_of(std::string_view name) {
  struct Row {
    std::string_view name;
    std::size_t numbers;
  };
  // The longer names first.
  constexpr std::array kRows{Row{"!ZZ", 3}, Row{"PA", 2}, Row{"PR", 2}, Row{"PU", 2}, Row{"PD", 2},
                             Row{"D", 2},   Row{"M", 2},  Row{"I", 2},  Row{"R", 2},  Row{"Z", 3}};
  const auto row = std::ranges::find_if(kRows, [&](const Row& one) { return name.ends_with(one.name); });
  return row == kRows.end() ? 0 : row->numbers;
}

// Where a set of a list is complete. A command may follow another without a delimiter, and a blank may divide numbers
// (guideline 2-2, 2-3).
class SetReader {
 public:
  // `numbers`: of a set of the list in which it begins; 0: it begins a command.
  explicit SetReader(std::size_t numbers) : numbers_(numbers) {}

  std::size_t numbers() const { return numbers_; }

  // Whether this is the comma behind a complete set.
  bool take(char c) {
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

 private:
  void take_name(char c) {
    name_ += is_letter(c) ? capital(c) : c;
    if (name_.size() > kLongestName) name_.erase(0, 1);
    numbers_ = set_of(name_);
    count_ = 0;
    in_number_ = false;
  }

  // Numbers that nothing divides are not counted: that list is not cut.
  void take_number(char c) {
    if (!std::exchange(in_number_, true)) {
      ++count_;
      has_point_ = c == '.';
    } else if (!is_digit(c) && (c != '.' || std::exchange(has_point_, true))) {
      numbers_ = 0;
    }
  }

  static constexpr std::size_t kLongestName = 3;
  std::string name_;
  std::size_t numbers_;
  std::size_t count_ = 0;
  bool in_number_ = false, has_point_ = false;
};

}  // namespace

Cutter::Cutter(std::string_view job, std::size_t window) : job_(job), window_(window), end_(find_end()) {}

void Cutter::next() {
  begin_ = end_;
  end_ = find_end();
}

std::size_t Cutter::end_of_delimiters(std::size_t at) const {
  while (at < job_.size() && is_between_commands(job_[at])) ++at;
  return at;
}

// A list is read no further than the window, if it can be cut there.
std::size_t Cutter::find_end() {
  SetReader reader(set_);
  std::size_t at = begin_, cut = 0, numbers = 0;  // of the list that is cut there
  do {
    for (; at < job_.size() && !ends_command(job_[at]); ++at) {
      if (cut != 0 && at >= begin_ + window_) {
        set_ = numbers;
        return cut;
      }
      if (!reader.take(job_[at])) continue;
      cut = at + 1;
      numbers = reader.numbers();
    }
    at = end_of_delimiters(at);
  } while (at < job_.size() && calls(job_.substr(begin_, at - begin_)));
  const bool whole = at - begin_ <= window_ || cut == 0;
  set_ = whole ? 0 : numbers;
  return whole ? at : cut;
}

}  // namespace axisgate::rml1
