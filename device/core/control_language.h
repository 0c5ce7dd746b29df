// Lines by which a person acts on a simulated device, such as `limit AXIS cw|ccw on|off`: description of the commands,
// reading of a line, and its reply.
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

// In a usage, a word in lower case is typed as it is, A|B is one of the two, and a word in capitals is a number in
// its own range (COMMAND for any word). A part in brackets, at the end, may be left out. Lines are not case-sensitive.
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

// Value of a part that the usage leaves open.
struct Argument {
  std::string_view word;  // word of the line; for A|B, the spelling of the usage
  double number = 0;      // value; for A|B, index of the choice, from 0
};

std::vector<std::string_view> words_of(std::string_view text);

// All commands of one device. Thread safe, because it never changes.
class ControlLanguage {
 public:
  // The objects that the views and the span refer to must outlive this one.
  ControlLanguage(std::vector<ControlUsage> commands, std::span<const NumberField> numbers)
      : commands_(std::move(commands)), numbers_(numbers) {}

  struct Call {
    std::size_t command = 0;  // index of the command
    std::vector<Argument> arguments;
  };
  // Reads a line without its end; the arguments point into the line. Fails with invalid_request; the message names the
  // word, and the hint the allowed words.
  Result<Call> read(std::string_view line) const;

  // Returns the reply to `help [COMMAND]`: every usage, or the meaning of one command with the ranges of its numbers.
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

// Returns one line for a person: "ok", "ok VALUE..." or "error: what; what to do".
std::string control_reply(const Result<std::string>& done);

}  // namespace axisgate
