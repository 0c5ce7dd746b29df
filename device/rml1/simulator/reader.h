// Converts bytes to commands (guideline 2). Written from the guideline, independently of device/rml1/language/parser.h.
#pragma once

#include <string>
#include <vector>

#include "device/rml1/machine/profile.h"
#include "device/rml1/simulator/command.h"
#include "device/rml1/simulator/number.h"

namespace axisgate::rml1::simulator {

class ReaderListener {
 public:
  virtual ~ReaderListener() = default;
  virtual void order(Order order) = 0;
  virtual void command_error(int number) = 0;  // 1, 2 or 3
};

// One byte gives at most three orders. Memory is bounded, even for a very long command.
class Reader {
 public:
  // Uses only the data of the dialect, which must outlive the reader.
  Reader(const Dialect& dialect, ReaderListener& listener) : dialect_(dialect), listener_(listener) {}

  void take(char byte);
  void forget();  // discards the command in progress, and a ^

 private:
  enum class State { search, name, one_more_letter, list, group };
  enum class Place { before_number, in_number, after_number, after_comma };

  // Each returns false if the byte must be read again in the new state.
  bool step(char byte);
  bool search(char byte);
  bool name(char byte);
  bool list(char byte);
  bool number_ended(char byte);
  bool group(char byte);

  void begin_name(char byte);
  bool second_letter_decides() const;
  const Command* known(const std::string& name) const;
  void unknown_name(State next);
  void begin(const Command& command);
  void begin_number(char byte);
  void push(double value);
  bool list_is_full() const;
  bool end_list();
  void emit();

  void group_letter(char letter);
  void end_axis();
  void end_group();
  void skip_groups(int error);
  bool moves_apart(const std::string& pair) const;

  const Dialect& dialect_;
  ReaderListener& listener_;
  State state_ = State::search;
  bool caret_ = false;  // a mode 2 command must follow (guideline 3-1 ^)
  bool stray_ = false;  // within numbers that belong to no command
  std::string name_;
  Order order_;
  Place place_ = Place::before_number;
  Number number_;
  char axis_ = 0;  // axis of !ZE, 0 between axes
  bool skipping_ = false;
};

}  // namespace axisgate::rml1::simulator
