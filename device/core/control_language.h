// The lines by which a person acts on a simulated device: `limit AXIS cw|ccw on|off`. How commands are written, how a
// line is read by that, and how it is answered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"

namespace axisgate {

inline constexpr std::size_t kControlLineMax = 200;  // characters of a command

// In a usage, words in lower case stand for themselves, A|B is one of them, those in capitals are a number in a range
// of their own (COMMAND is any word), and what is in brackets, at the end, may be left out. Capitals and small letters
// are the same in a line.
struct ControlUsage {
  std::string_view usage;
  std::string_view meaning;
};

// A word in capitals that stands for a number.
struct NumberField {
  std::string_view name;
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  bool fractions = false;
};

// What a line has where its usage leaves a choice.
struct Argument {
  std::string_view word;  // of A|B as the usage writes it
  double number = 0;      // of A|B which of them it is, from 0
};

std::vector<std::string_view> words_of(std::string_view text);

// All commands of one device. Thread safe: it never changes.
class ControlLanguage {
 public:
  // What the views and the span point to outlives this.
  ControlLanguage(std::vector<ControlUsage> commands, std::span<const NumberField> numbers)
      : commands_(std::move(commands)), numbers_(numbers) {}

  struct Call {
    std::size_t command = 0;  // its place among the commands
    std::vector<Argument> arguments;
  };
  // A line without its end; the arguments point into it. A refusal names the word, and what may be said instead.
  Result<Call> read(std::string_view line) const;

  // The reply to `help [COMMAND]`: every usage, or what one command does and the ranges of its numbers.
  Result<std::string> help(const std::vector<Argument>& arguments) const;

 private:
  Result<std::vector<Argument>> read_arguments(const std::vector<std::string_view>& words,
                                               std::string_view usage) const;
  bool take_word(std::string_view word, std::string_view place, std::vector<Argument>& arguments) const;
  const NumberField* number_called(std::string_view name) const;
  std::string with_ranges(std::string_view usage) const;
  const ControlUsage* command_called(std::string_view name) const;
  tl::unexpected<Problem> refuse(std::string what) const;

  std::vector<ControlUsage> commands_;
  std::span<const NumberField> numbers_;
};

// One line for a person: "ok", "ok VALUE..." or "error: what; what to do".
std::string control_reply(const Result<std::string>& done);

}  // namespace axisgate
