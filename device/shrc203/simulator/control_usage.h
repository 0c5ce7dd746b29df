// How a command of control.cc is written, and how a line is read by that: `limit AXIS cw|ccw on|off`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"

namespace axisgate::shrc203::simulator {

// What a line has where its usage leaves a choice. Words in lower case stand for themselves, A|B is one of them, those
// in capitals are a number in a range of their own (COMMAND is any word), and what is in brackets, at the end, may be
// left out. Capitals and small letters are the same in a line.
struct Argument {
  std::string_view word;  // of A|B as the usage writes it
  double number = 0;      // of A|B which of them it is, from 0
};

std::vector<std::string_view> words_of(std::string_view text);
bool same_word(std::string_view one, std::string_view other);

// The usage, and what its numbers may be.
std::string with_ranges(std::string_view usage);

// Of the words of a line. A refusal names the word, and the usage.
Result<std::vector<Argument>> read_arguments(const std::vector<std::string_view>& words, std::string_view usage);

}  // namespace axisgate::shrc203::simulator
