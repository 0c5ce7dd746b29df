#include "device/rml1/sending/cut.h"

#include <algorithm>
#include <array>

namespace axisgate::rml1 {
namespace {

bool is_between_commands(char c) { return c == ';' || static_cast<unsigned char>(c) <= ' '; }
bool ends_command(char c) { return is_between_commands(c) && c != ' ' && c != '\t'; }

// A circumflex waits for the next command, across delimiters (guideline 1-2).
bool calls(std::string_view command) {
  const auto last = std::ranges::find_if_not(command.rbegin(), command.rend(), is_between_commands);
  return last != command.rend() && *last == '^';
}

// How many numbers make a set; 0: the command takes no list of sets (guideline 5-1).
std::size_t set_of(std::string_view command) {
  struct Row {
    std::string_view name;
    std::size_t numbers;
  };
  // The longer names first.
  constexpr std::array kRows{Row{"!ZZ", 3}, Row{"PA", 2}, Row{"PR", 2}, Row{"PU", 2}, Row{"PD", 2},
                             Row{"D", 2},   Row{"M", 2},  Row{"I", 2},  Row{"R", 2},  Row{"Z", 3}};
  const auto name = command.substr(std::min(command.size(), command.find_first_not_of("^ \t")));
  const auto row = std::ranges::find_if(kRows, [&](const Row& one) { return name.starts_with(one.name); });
  return row == kRows.end() ? 0 : row->numbers;
}

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
  const std::size_t numbers = set_ != 0 ? set_ : set_of(job_.substr(begin_));
  std::size_t at = begin_, cut = 0, commas = 0;
  do {
    for (; at < job_.size() && !ends_command(job_[at]); ++at) {
      if (cut != 0 && at >= begin_ + window_) {
        set_ = numbers;
        return cut;
      }
      if (numbers != 0 && job_[at] == ',' && ++commas % numbers == 0) cut = at + 1;
    }
    at = end_of_delimiters(at);
  } while (at < job_.size() && calls(job_.substr(begin_, at - begin_)));
  const bool whole = at - begin_ <= window_ || cut == 0;
  set_ = whole ? 0 : numbers;
  return whole ? at : cut;
}

}  // namespace axisgate::rml1
