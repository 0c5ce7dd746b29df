#include "device/rml1/language/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "device/rml1/language/characters.h"
#include "device/rml1/language/quoted.h"

namespace axisgate::rml1 {
namespace {

bool is_of_a_number(char c) { return begins_number(c) || c == ','; }

// Number of bytes kept of a run of digits; more than a message shows.
constexpr std::size_t kStrayKept = 32;

std::vector<Row> rows_of(const Dialect& dialect, std::span<const Row> more) {
  std::vector<Row> rows(more.begin(), more.end());
  if (dialect.tolerates("J")) rows.push_back(tolerated_row("J"));
  return rows;
}

}  // namespace

Parser::Parser(const Dialect& dialect, Diagnostics& diagnostics, ParserListener& listener, std::span<const Row> more)
    : diagnostics_(diagnostics),
      listener_(listener),
      table_(guideline_rows(), rows_of(dialect, more)),
      dialect_(dialect),
      axes_(dialect_.apart, diagnostics),
      spindle_(&tolerated_row("!")) {}

void Parser::feed(std::string_view bytes) {
  for (const char c : bytes) {
    if (state_ == State::number && is_digit(c) && control_.idle()) {
      (void)number_.take(c);  // most of the bytes of most jobs
    } else if (c != DeviceControl::kEscape && control_.idle()) {
      take(c);
    } else {
      control(c);
    }
    ++offset_;
    if (c == '\n') {
      ++line_;
      line_start_ = offset_;
    }
  }
}

void Parser::skip(std::size_t bytes) { offset_ += bytes; }

void Parser::control(char c) {
  switch (control_.take(c)) {
    case DeviceControl::Found::held:
      if (c == DeviceControl::kEscape) escape_place_ = place();
      return;
    case DeviceControl::Found::escape:
      take_at(escape_place_, DeviceControl::kEscape);
      control(c);
      return;
    case DeviceControl::Found::quit:
      diagnostics_.error(0, escape_place_, "4-2", [] {
        return "ESC.K makes the machine discard what it has received: it has no place in a job";
      });
      listener_.quit();
      return;
    case DeviceControl::Found::unknown:
      diagnostics_.error(11, escape_place_, "4-1",
                         [] { return "an unknown device control sequence: ESC and the point are discarded"; });
      take(c);
      return;
    case DeviceControl::Found::data:
      take(c);
      return;
  }
}

// Takes a byte that was kept back. It is in the same line.
void Parser::take_at(const jobs::Place& place, char c) {
  const auto here = offset_;
  offset_ = place.offset;
  take(c);
  offset_ = here;
}

void Parser::take(char c) {
  while (!step(c)) {
  }
}

// Takes a byte. Returns false if the state has changed and the byte must be taken again.
bool Parser::step(char c) {
  switch (state_) {
    case State::search:
      return search(c);
    case State::stray:
      return stray(c);
    case State::second_letter:
      return second_letter(c);
    case State::common_first:
      return common_first(c);
    case State::common_second:
      return common_second(c);
    case State::begin_list:
    case State::after_comma:
      return begin_list(c);
    case State::number:
      return in_number(c);
    case State::after_number:
      return after_number(c);
    case State::axes:
      return in_axes(c);
  }
  return true;
}

bool Parser::search(char c) {
  if (is_delimiter(c)) return true;
  name_place_ = place();
  first_ = c;
  if (is_letter(c)) {
    const Row* row = called_ || table_.begins_pair(c) ? nullptr : table_.one_letter(c);
    if (row != nullptr) {
      begin_command(*row);
    } else {
      state_ = State::second_letter;
    }
  } else if (is_of_a_number(c)) {
    called_ = false;
    stray_ = c;
    state_ = State::stray;
  } else if (c == '!') {
    state_ = State::common_first;
  } else if (const Row* row = has_eighth_bit(c) ? nullptr : table_.one_letter(c); row != nullptr && !called_) {
    begin_command(*row);
  } else {
    unknown();
  }
  return true;
}

bool Parser::stray(char c) {
  if (is_of_a_number(c)) {
    if (stray_.size() < kStrayKept) stray_ += c;
    return true;
  }
  diagnostics_.error(2, name_place_, "2-3",
                     [this] { return "a number where a command is expected: " + in_quotes(stray_); });
  state_ = State::search;
  return false;
}

bool Parser::second_letter(char c) {
  if (is_blank(c)) return true;
  const Row* pair = is_letter(c) ? table_.two_letters(first_, c) : nullptr;
  if (pair != nullptr) {
    begin_command(*pair);
    return true;
  }
  const Row* single = called_ ? nullptr : table_.one_letter(first_);
  if (single != nullptr) {
    begin_command(*single);
    return false;
  }
  unknown(c);
  // Consumes a letter: "it is necessary to get one more letter" (2-5).
  return is_letter(c);
}

bool Parser::common_first(char c) {
  if (is_blank(c)) return true;
  if (is_letter(c)) {
    first_ = c;
    state_ = State::common_second;
    return true;
  }
  if ((c == '0' || c == '1') && dialect_.tolerates(c == '0' ? "!0" : "!1")) {
    begin_command(*spindle_);
    return false;
  }
  unknown();
  return false;
}

bool Parser::common_second(char c) {
  if (is_blank(c)) return true;
  const Row* row = is_letter(c) ? table_.common(first_, c) : nullptr;
  if (row != nullptr) {
    begin_command(*row);
    return true;
  }
  unknown(c);
  return is_letter(c);
}

void Parser::unknown(char second) {
  const bool eighth_bit = has_eighth_bit(first_);
  const int number = called_ && !eighth_bit ? 2 : 1;
  diagnostics_.error(number, name_place_, number == 2 ? "3-1" : "2-3", [&]() -> std::string {
    std::string letters = state_ == State::common_second ? "!" : "";
    letters += first_;
    if (is_letter(second)) letters += second;
    const std::string name = in_quotes(letters);
    if (eighth_bit) return fmt::format("a byte of 0x80 or more is no part of RML-1: {}", name);
    if (number == 2) return fmt::format("^ is followed by {}, which is no mode 2 command", name);
    return "there is no command " + name;
  });
  called_ = false;
  state_ = State::search;
}

void Parser::begin_command(const Row& row) {
  begin_ = called_ ? call_place_.offset : name_place_.offset;
  called_ = row.operation == Operation::call;
  state_ = State::search;
  if (called_) {
    call_place_ = name_place_;
    return;
  }
  ++commands_;
  row_ = &row;
  instruction_.row = &row;
  instruction_.place = name_place_;
  instruction_.count = 0;
  instruction_.given = {};
  instruction_.axes = {};
  emitted_ = false;
  if (row.beyond_guideline) {
    diagnostics_.warn(Warning::beyond_guideline, name_place_, row.section,
                      [&row] { return fmt::format("{} is beyond the guideline; this machine takes it", row.name); });
  }
  switch (row.takes) {
    case Takes::nothing:
      emit();
      return;
    case Takes::axes:
      state_ = State::axes;
      axes_.begin();
      return;
    case Takes::up_to:
    case Takes::sets:
      state_ = State::begin_list;
  }
}

bool Parser::in_axes(char c) {
  const AxesReader::Found found = axes_.take(c, place());
  if (found == AxesReader::Found::group || found == AxesReader::Found::last) {
    instruction_.axes = axes_.targets();
    emit();
  }
  if (found == AxesReader::Found::last || found == AxesReader::Found::end) state_ = State::search;
  return true;
}

bool Parser::begin_list(char c) {
  if (is_blank(c)) return true;
  if (begins_number(c)) {
    begin_number(c);
    return true;
  }
  end_list();
  return false;
}

void Parser::begin_number(char c) {
  number_place_ = place();
  number_.begin(c);
  state_ = State::number;
}

bool Parser::in_number(char c) {
  if (number_.take(c)) return true;
  const bool lone = number_.sign_alone() || number_.point_alone();
  end_number();
  const bool comma = c == ',' && !number_.sign_alone();
  const bool continues = !list_full() && (comma || (is_blank(c) && !lone));
  if (!continues) {
    end_list();
    return false;
  }
  state_ = comma ? State::after_comma : State::after_number;
  return true;
}

// Blanks between two numbers count as a comma ("PA 100 . 0, 100; = PA100,0;0,100;", 2-5).
bool Parser::after_number(char c) {
  if (is_blank(c)) return true;
  if (c == ',') {
    state_ = State::after_comma;
    return true;
  }
  return begin_list(c);
}

void Parser::end_number() {
  if (number_.sign_alone()) {
    diagnostics_.note(number_place_, "2-5", [] { return "a sign without a number ends the list"; });
    return;
  }
  take_value(number_.value());
}

void Parser::take_value(double value) {
  const std::size_t index = instruction_.count++;
  bool good = true;
  instruction_.values[index] = in_range(row_->parameters[index], value, good);
  instruction_.given[index] = good;
  instruction_.places[index] = number_place_;
  if (row_->takes == Takes::sets && instruction_.count == row_->count) emit();
}

double Parser::in_range(const Parameter& parameter, double value, bool& good) {
  const bool low = value<parameter.lowest, high = value> parameter.highest;
  if (!low && !high) return parameter.whole ? std::trunc(value) : value;
  if (low ? parameter.lowest_stated : parameter.highest_stated) {
    diagnostics_.error(3, number_place_, row_->section, [&] {
      return fmt::format("{} takes {} to {}: {} is not used", row_->name, parameter.lowest, parameter.highest, value);
    });
    good = false;
    return value;
  }
  const double nearest = low ? parameter.lowest : parameter.highest;
  diagnostics_.warn(Warning::out_of_range, number_place_, "2-5", [&] {
    return fmt::format("{} takes {} to {}: {} is used instead of {}", row_->name, parameter.lowest, parameter.highest,
                       nearest, value);
  });
  return nearest;
}

void Parser::emit() {
  instruction_.first = !emitted_;
  instruction_.end = offset_ + 1;
  emitted_ = true;
  listener_.execute(instruction_);
  instruction_.count = 0;
}

void Parser::end_list() {
  state_ = State::search;
  const int left = instruction_.count;
  if (row_->takes == Takes::up_to) {
    const auto given = instruction_.given.begin();
    const bool all_in_error = left > 0 && std::none_of(given, given + left, [](bool good) { return good; });
    if (!all_in_error) emit();
    return;
  }
  const jobs::Place first_left = instruction_.places[0];
  instruction_.count = 0;
  if (!emitted_) emit();
  if (left == 0) return;
  diagnostics_.error(2, first_left, row_->section, [&] {
    return fmt::format("{} takes sets of {} numbers: {} is left of a set, and not executed", row_->name, row_->count,
                       fmt::join(instruction_.values.begin(), instruction_.values.begin() + left, ","));
  });
}

// Ends the last command as if a terminator came. Axisgate sends a terminator after each job; other programs may not.
void Parser::end_last_command() {
  const bool in_list = state_ == State::begin_list || state_ == State::number || state_ == State::after_number ||
                       state_ == State::after_comma;
  const auto before = commands_;
  take(';');
  const bool single = commands_ != before;  // D, I or V, which waited for a second letter
  if (!in_list && !single) return;
  diagnostics_.warn(Warning::open_end, instruction_.place, "2-3", [this] {
    return fmt::format(
        "the job ends within {}: sent without a terminator, the machine waits, and takes the next job's first bytes "
        "for its parameters",
        row_->name);
  });
}

void Parser::finish() {
  executed_size_ = state_ == State::axes ? begin_of_open_group() : offset_;
  if (control_.cut_off()) {
    diagnostics_.error(11, escape_place_, "4-1", [] { return "the job ends within a device control sequence"; });
  }
  if (state_ == State::axes) {
    diagnostics_.warn(Warning::open_end, instruction_.place, "3-3", [] {
      return "!ZE has no terminator: what follows its last separator is neither executed nor sent";
    });
  } else {
    end_last_command();
  }
  if (called_) {
    diagnostics_.error(0, call_place_, "3-1",
                       [] { return "^ at the end of the job would change the next job's first command"; });
  }
}

}  // namespace axisgate::rml1
