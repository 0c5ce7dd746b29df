// Programs as P:SET stores them and P:GET reads them (manual 112) to 116)), and the progress of a running program.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "device/shrc203/simulator/axis_set.h"
#include "device/shrc203/simulator/buffer.h"

namespace axisgate::shrc203::simulator {

// Kinds of program lines, in the order of manual 114) (1) to (17).
enum class Pattern {
  relative,
  absolute,
  line,
  continuous,  // CM, CA
  arc,
  helix,
  registered,
  origin_return,
  logical_return,
  set_origin,
  input,
  loop_start,
  loop_end,
  end,
  none,
};

struct Trigger {
  static constexpr int kOneShot = 4;
  static constexpr int kProhibited = 5;
  static constexpr int kAsBefore = 6;

  int mode = kProhibited;     // 0 to 6, as tm
  int axis = 1;               // ta
  std::int64_t interval = 0;  // tv: pulses, or hundredths of a second
};

struct Instruction {
  Pattern pattern = Pattern::none;
  std::string text = "NONE";  // answer to P:GET
  Axes axes;
  std::array<std::int64_t, kAxes> values{};  // ap1 to ap3, or the registration number of each axis
  std::optional<Arc> arc;
  int output = 0;
  int speed = 1;
  int wait_tenths = 0;
  Trigger trigger;
  int inputs = 0;
  int nest = 1;
  int repeats = 0;
};

// Reads the text after P:SET,n, in upper case and without blanks. nullopt if the manual allows no such line.
std::optional<Instruction> read_instruction(std::string_view text);

class Program {
 public:
  static constexpr int kLines = 4000;

  // Creates a program with END in the first line and NONE in the others (manual 114) (16) and (17)).
  Program();

  Instruction at(int line) const;
  void set(int line, const Instruction& instruction);  // NONE deletes the line
  void add_missing_end();                              // manual 112)
  int next_registered(int line) const;  // first line from this one on that is not NONE; kLines + 1 if there is none

 private:
  std::map<int, Instruction> lines_;  // lines that are not NONE
};

struct ProgramRun {
  static constexpr int kNests = 9;

  // Digit of ?:L (manual 41)); other_axes and later: the program stopped during processing.
  enum class Status { not_executed, executing, paused, one_line, other_axes, error, unexpected, unexcited, busy };
  enum class Step { between_lines, moving, waiting, input };
  struct Loop {
    int line = 0;  // line of its F; 0 if there was none
    int left = 0;
  };

  bool active() const { return status == Status::executing || status == Status::paused || status == Status::one_line; }

  Status status = Status::not_executed;
  Step step = Step::between_lines;
  int line = 1;
  Axes axes;        // axes that this line moves
  TimePoint due{};  // start of the next line, or end of this line's wait
  std::array<Loop, kNests> loops{};
  Trigger trigger;                       // of the last line that set one
  std::optional<TimePoint> trigger_due;  // next check of the trigger output
  std::int64_t triggers_reported = 0;    // pulses emitted up to the last check
};

// Program mode (manual 102) to 116)), except ?:MODE, which the Rig keeps.
struct ProgramMode {
  static constexpr int kPrograms = 8;
  static constexpr std::size_t kNoticesMax = 1000;  // notices waiting to be written; further ones are lost

  void power_on();  // keeps the programs; changes that P:OFF has not saved are lost
  Program& chosen() { return programs[static_cast<std::size_t>(number - 1)]; }
  const Program& chosen() const { return programs[static_cast<std::size_t>(number - 1)]; }
  void tell(std::string_view notice);

  std::array<Program, kPrograms> programs;
  int number = 1;                   // manual 104)
  bool reports_completion = false;  // manual 109)
  bool reports_trigger = false;     // manual 110)
  bool editing = false;             // manual 111)
  Program edited;                   // copy of the chosen program during editing
  ProgramRun run;
  std::vector<std::string> notices;  // COMP and TRIG that are due on the line
};

}  // namespace axisgate::shrc203::simulator
