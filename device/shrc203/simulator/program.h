// Programs as P:SET stores them and P:GET reads them back (manual 112) to 116)), and how far one has run.
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

// Manual 114) (1) to (17), in its order.
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
  std::string text = "NONE";  // as P:GET answers
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

// What follows P:SET,n, or nothing where the manual allows no such line. In upper case and without blanks.
std::optional<Instruction> read_instruction(std::string_view text);

class Program {
 public:
  static constexpr int kLines = 4000;

  // Manual 114) (16) and (17): END in the first line, NONE in the others.
  Program();

  Instruction at(int line) const;
  void set(int line, const Instruction& instruction);  // NONE deletes it
  void add_missing_end();                              // manual 112)
  int next_registered(int line) const;                 // from this line on; kLines + 1 when there is none

 private:
  std::map<int, Instruction> lines_;  // those that are not NONE
};

struct ProgramRun {
  static constexpr int kNests = 9;

  // The digit of ?:L (manual 41)); from other_axes on: stopped while processing.
  enum class Status { not_executed, executing, paused, one_line, other_axes, error, unexpected, unexcited, busy };
  enum class Step { between_lines, moving, waiting, input };
  struct Loop {
    int line = 0;  // of its F, 0 when none was met
    int left = 0;
  };

  bool active() const { return status == Status::executing || status == Status::paused || status == Status::one_line; }

  Status status = Status::not_executed;
  Step step = Step::between_lines;
  int line = 1;
  Axes axes;        // that this line moves
  TimePoint due{};  // when the next line begins, or the wait of this one is over
  std::array<Loop, kNests> loops{};
  Trigger trigger;                       // of the last line that has set one
  std::optional<TimePoint> trigger_due;  // when the trigger output is looked at next
  std::int64_t triggers_reported = 0;    // of those that the trigger output has emitted
};

// Program mode (manual 102) to 116)), but for ?:MODE, which the rig keeps.
struct ProgramMode {
  static constexpr int kPrograms = 8;
  static constexpr std::size_t kNoticesMax = 1000;  // that wait to be written; more are lost

  void power_on();  // the programs are kept, what P:OFF has not saved is lost
  Program& chosen() { return programs[static_cast<std::size_t>(number - 1)]; }
  const Program& chosen() const { return programs[static_cast<std::size_t>(number - 1)]; }
  void tell(std::string_view notice);

  std::array<Program, kPrograms> programs;
  int number = 1;                   // manual 104)
  bool reports_completion = false;  // manual 109)
  bool reports_trigger = false;     // manual 110)
  bool editing = false;             // manual 111)
  Program edited;                   // the chosen one while it is edited
  ProgramRun run;
  std::vector<std::string> notices;  // COMP and TRIG that are due on the line
};

}  // namespace axisgate::shrc203::simulator
