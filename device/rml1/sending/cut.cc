#include "device/rml1/sending/cut.h"

#include <algorithm>
#include <array>

namespace axisgate::rml1 {
namespace {

bool is_delimiter(char c) { return c == ';' || static_cast<unsigned char>(c) <= ' '; }
bool ends_command(char c) { return is_delimiter(c) && c != ' ' && c != '\t'; }

// A circumflex waits for the next command, across delimiters (guideline 1-2).
bool calls(std::string_view command) {
  const auto last = std::ranges::find_if_not(command.rbegin(), command.rend(), is_delimiter);
  return last != command.rend() && *last == '^';
}

std::size_t end_of_command(std::string_view job, std::size_t begin) {
  auto end = begin;
  do {
    while (end < job.size() && !ends_command(job[end])) ++end;
    while (end < job.size() && is_delimiter(job[end])) ++end;
  } while (end < job.size() && calls(job.substr(begin, end - begin)));
  return end;
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

std::size_t next_cut(std::string_view job, std::size_t begin, std::size_t window) {
  const std::size_t end = end_of_command(job, begin);
  if (end - begin <= window) return end;
  std::size_t first = begin;  // of the command to which a list belongs
  while (first > 0 && job[first - 1] == ',') {
    first = job.find_last_of(";\r\n", first - 1);
    first = first == std::string_view::npos ? 0 : first + 1;
  }
  const std::size_t numbers = set_of(job.substr(first, end - first));
  if (numbers == 0) return end;
  std::size_t cut = 0, commas = 0;
  for (std::size_t at = begin; at < end && (cut == 0 || at < begin + window); ++at) {
    if (job[at] == ',' && ++commas % numbers == 0) cut = at + 1;
  }
  return cut == 0 ? end : cut;
}

}  // namespace axisgate::rml1
