// Reads a job in bounded memory. Its instructions and diagnostics are the same for any split of the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/language/axes_reader.h"
#include "device/rml1/language/device_control.h"
#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/dialect.h"
#include "device/rml1/language/instruction.h"
#include "device/rml1/language/number_reader.h"

namespace axisgate::rml1 {

class ParserListener : public InstructionListener {
 public:
  // Reports ESC.K, which ends the command in execution and discards the buffer (guideline 4-2).
  virtual void quit() = 0;
};

// Not thread safe. The listener is called while bytes are fed.
class Parser {
 public:
  // `more`: rows in addition to the guideline's, for tests of the reading of parameters.
  Parser(const Dialect& dialect, Diagnostics& diagnostics, ParserListener& listener, std::span<const Row> more = {});

  void feed(std::string_view bytes);
  void skip(std::size_t bytes);  // bytes of the first line that were judged elsewhere
  void finish();                 // the job ends here

  std::uint64_t commands() const { return commands_; }  // number of known commands, executed or in error
  // After finish(): number of bytes up to the part that is left open and not executed, which is the last group of a !ZE
  // without a terminator; otherwise all bytes. The next bytes on the line would execute that group.
  std::uint64_t executed_size() const { return executed_size_; }

 private:
  enum class State : std::uint8_t {
    search,         // searches for a command
    stray,          // in a run of digits that belong to no command: stray_
    second_letter,  // second letter of a mode 2 command
    common_first,   // first letter after "!"
    common_second,
    begin_list,  // no parameter yet
    number,
    after_number,  // blanks after a number
    after_comma,
    axes,  // !ZE
  };

  jobs::Place place() const { return {offset_, line_, offset_ - line_start_ + 1}; }  // place of the next byte
  void control(char c);
  void take(char c);
  void take_at(const jobs::Place& place, char c);
  bool step(char c);
  bool search(char c);
  bool stray(char c);
  bool second_letter(char c);
  bool common_first(char c);
  bool common_second(char c);
  bool begin_list(char c);
  bool in_number(char c);
  bool after_number(char c);
  bool in_axes(char c);

  void begin_command(const Row& row);
  void begin_number(char c);
  void end_number();
  void take_value(double value);
  double in_range(const Parameter& parameter, double value, bool& good);
  bool list_full() const { return row_->takes == Takes::up_to && instruction_.count == row_->count; }
  void end_list();
  void emit();
  void unknown(char second = 0);  // `second`: second letter of the name that began with first_
  void end_last_command();
  // A group ends with the letter that begins the next one.
  std::uint64_t begin_of_open_group() const { return emitted_ ? instruction_.end - 1 : begin_; }

  Diagnostics& diagnostics_;
  ParserListener& listener_;
  InstructionTable table_;
  Dialect dialect_;
  DeviceControl control_;
  AxesReader axes_;
  const Row* spindle_;  // the form !0, !1

  std::uint64_t offset_ = 0, line_ = 1, line_start_ = 0;
  std::uint64_t commands_ = 0;
  State state_ = State::search;
  bool called_ = false;  // called by ^: a mode 2 name must follow
  jobs::Place call_place_;
  std::uint64_t begin_ = 0;  // first byte of the command, including the ^ that calls it
  std::uint64_t executed_size_ = 0;
  char first_ = 0;          // first letter of a name
  jobs::Place name_place_;  // place of the name's first byte
  std::string stray_;
  jobs::Place number_place_, escape_place_;
  NumberReader number_;
  const Row* row_ = nullptr;
  Instruction instruction_;
  bool emitted_ = false;  // a set of this command was emitted
};

}  // namespace axisgate::rml1
