#include "device/rml1/simulator/reader.h"

#include <algorithm>
#include <utility>

namespace axisgate::rml1::simulator {
namespace {

constexpr int kNoSuchCommand = 1, kBadParameters = 2, kOutOfRange = 3;  // guideline 2, 3

bool is_blank(char byte) { return byte == ' ' || byte == '\t'; }

// Reports whether a byte may come before a command (guideline 2-2 [Delimiter]). Bytes of 0x80 or more may not.
bool is_delimiter(char byte) { return static_cast<unsigned char>(byte) <= 0x20 || byte == ';'; }

char capital(char byte) { return byte >= 'a' && byte <= 'z' ? static_cast<char>(byte - 'a' + 'A') : byte; }

bool is_letter(char byte) { return capital(byte) >= 'A' && capital(byte) <= 'Z'; }

bool has(const std::vector<std::string>& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

}  // namespace

void Reader::take(char byte) {
  while (!step(byte)) {
  }
}

void Reader::forget() {
  state_ = State::search;
  caret_ = stray_ = false;
}

bool Reader::step(char byte) {
  switch (state_) {
    case State::search:
      return search(byte);
    case State::name:
      return name(byte);
    case State::one_more_letter:
      if (is_blank(byte)) return true;
      state_ = State::search;
      return is_letter(byte);
    case State::list:
      return list(byte);
    case State::group:
      return group(byte);
  }
  return true;
}

bool Reader::search(char byte) {
  if (is_delimiter(byte)) {
    stray_ = false;
    return true;
  }
  if (may_begin_number(byte) || byte == ',') {
    if (!std::exchange(stray_, true)) listener_.command_error(kBadParameters);
    caret_ = false;
    return true;
  }
  stray_ = false;
  if (is_letter(byte) || byte == '!' || byte == '@') {
    begin_name(byte);
  } else if (byte == '^' && !caret_) {
    caret_ = true;
  } else {
    const bool eight_bits = static_cast<unsigned char>(byte) >= 0x80;
    const bool after_caret = std::exchange(caret_, false);
    listener_.command_error(after_caret && !eight_bits ? kBadParameters : kNoSuchCommand);
  }
  return true;
}

void Reader::begin_name(char byte) {
  name_ = capital(byte);
  state_ = State::name;
  if (name_ == "!" || (caret_ && name_ != "@") || name_ == "P" || second_letter_decides()) return;
  if (const Command* command = known(name_)) {
    begin(*command);
  } else {
    unknown_name(name_ == "@" ? State::search : State::one_more_letter);
  }
}

// D, I and V are commands, and also begin DF, IN and VS.
bool Reader::second_letter_decides() const {
  return !caret_ && name_.size() == 1 && std::string_view("DIV").find(name_.front()) != std::string_view::npos;
}

bool Reader::name(char byte) {
  if (is_blank(byte)) return true;
  if (second_letter_decides()) {
    const Command* longer = is_letter(byte) ? known(name_ + capital(byte)) : nullptr;
    begin(longer != nullptr ? *longer : *known(name_));
    return longer != nullptr;
  }
  const bool old_spindle_form = name_ == "!" && (byte == '0' || byte == '1') && has(dialect_.tolerated, name_ + byte);
  if (!is_letter(byte) && !old_spindle_form) {
    unknown_name(State::search);
    return false;
  }
  name_ += capital(byte);
  const std::size_t size = name_.front() == '!' && !old_spindle_form ? 3 : 2;
  if (name_.size() < size) return true;
  if (const Command* command = known(name_)) {
    begin(*command);
  } else {
    unknown_name(State::search);
  }
  return true;
}

const Command* Reader::known(const std::string& name) const {
  const bool depends_on_machine = name == "J" || name == "!0" || name == "!1";
  if (depends_on_machine && !has(dialect_.tolerated, name)) return nullptr;
  const Command* command = find_command(name);
  const bool common = name.front() == '!';
  if (command != nullptr && caret_ && !common && !is_mode_2(*command)) return nullptr;
  return command;
}

void Reader::unknown_name(State next) {
  listener_.command_error(std::exchange(caret_, false) ? kBadParameters : kNoSuchCommand);
  state_ = next;
}

void Reader::begin(const Command& command) {
  caret_ = false;
  order_ = Order{&command, {}, {}, true};
  place_ = Place::before_number;
  axis_ = 0;
  number_ = {};
  skipping_ = false;
  if (command.action == Action::extension) {
    state_ = State::group;
  } else if (command.numbers > 0) {
    state_ = State::list;
  } else {
    state_ = State::search;
    emit();
  }
}

void Reader::emit() {
  listener_.order(order_);
  order_.numbers.clear();
  order_.axes.clear();
  order_.first = false;
}

bool Reader::list(char byte) {
  if (place_ == Place::in_number) return number_.take(byte) || number_ended(byte);
  if (is_blank(byte)) return true;
  if (may_begin_number(byte)) {
    begin_number(byte);
    return true;
  }
  if (byte == ',' && place_ == Place::after_number) {
    place_ = Place::after_comma;
    return true;
  }
  return end_list();
}

void Reader::begin_number(char byte) {
  number_ = {};
  number_.take(byte);
  place_ = Place::in_number;
}

// `byte` is the first after the number (guideline 2-5).
bool Reader::number_ended(char byte) {
  if (number_.is_sign_alone()) return end_list();
  push(number_.value());
  if (list_is_full() || (number_.is_point_alone() && byte != ',')) return end_list();
  if (byte == ',') {
    place_ = Place::after_comma;
    return true;
  }
  if (!is_blank(byte)) return end_list();
  place_ = Place::after_number;
  return true;
}

void Reader::push(double value) {
  order_.numbers.push_back(value);
  if (order_.command->sets && list_is_full()) emit();
}

bool Reader::list_is_full() const { return static_cast<int>(order_.numbers.size()) >= order_.command->numbers; }

bool Reader::end_list() {
  state_ = State::search;
  if (!order_.command->sets) {
    emit();
    return false;
  }
  const bool incomplete = !order_.numbers.empty();
  order_.numbers.clear();
  if (order_.first) emit();
  if (incomplete) listener_.command_error(kBadParameters);
  return false;
}

bool Reader::group(char byte) {
  if (byte == ';' || byte == '\r' || byte == '\n') {
    if (!skipping_) end_group();
    state_ = State::search;
    return true;
  }
  if (skipping_) return true;
  if (is_blank(byte)) {
    if (!number_.empty()) end_axis();
  } else if (is_letter(byte)) {
    group_letter(capital(byte));
  } else if (byte == ':') {
    end_group();
  } else if (axis_ == 0 || !number_.take(byte)) {
    skip_groups(kOutOfRange);
  }
  return true;
}

void Reader::group_letter(char letter) {
  end_axis();
  if (skipping_) return;
  const auto same = [letter](const AxisNumber& axis) { return axis.axis == letter; };
  if (std::any_of(order_.axes.begin(), order_.axes.end(), same)) {
    skip_groups(kBadParameters);
  } else {
    axis_ = letter;
  }
}

void Reader::end_axis() {
  if (axis_ == 0) return;
  if (number_.empty() || number_.is_sign_alone()) return skip_groups(kOutOfRange);
  order_.axes.push_back({std::exchange(axis_, '\0'), number_.value(), number_.has_point()});
  number_ = {};
}

void Reader::end_group() {
  end_axis();
  if (skipping_ || order_.axes.empty()) return;
  if (std::any_of(dialect_.apart.begin(), dialect_.apart.end(),
                  [this](const std::string& pair) { return moves_apart(pair); })) {
    return skip_groups(kOutOfRange);
  }
  emit();
}

bool Reader::moves_apart(const std::string& pair) const {
  return std::all_of(pair.begin(), pair.end(), [this](char letter) {
    return std::any_of(order_.axes.begin(), order_.axes.end(),
                       [letter](const AxisNumber& axis) { return axis.axis == letter; });
  });
}

void Reader::skip_groups(int error) {
  listener_.command_error(error);
  skipping_ = true;
}

}  // namespace axisgate::rml1::simulator
