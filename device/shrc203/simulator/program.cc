#include "device/shrc203/simulator/program.h"

#include <algorithm>
#include <utility>

#include "device/shrc203/simulator/commands/reader.h"

namespace axisgate::shrc203::simulator {
namespace {

constexpr std::int64_t kWaitMax = 2560;
constexpr std::int64_t kTriggerMinimum = 2;
constexpr std::int64_t kTriggerPulsesMax = 30'000;
constexpr std::int64_t kTriggerHundredthsMax = 10'000;

// The fields of one line, from the left. A field that is missing or out of range makes the whole line invalid.
class Fields {
 public:
  explicit Fields(std::string_view text) : rest_(text) {}

  std::string_view name() {
    const std::string_view field = next();
    text_ = field;
    return field;
  }

  std::int64_t number(std::int64_t lowest, std::int64_t highest) {
    Reader reader(next());
    const int sign = reader.take_sign();
    const auto digits = reader.take_integer(0, kCoordinateMax);
    const std::int64_t value = digits ? sign * *digits : lowest;
    valid_ = valid_ && digits && reader.done() && value >= lowest && value <= highest;
    text_ += ',' + std::to_string(value);
    return value;
  }

  int small(int lowest, int highest) { return static_cast<int>(number(lowest, highest)); }
  std::int64_t coordinate() { return number(-kCoordinateMax, kCoordinateMax); }

  Axes axes() {
    Axes result;
    for (const int axis : kAxisNumbers) {
      if (small(0, 1) == 1) result.add(axis);
    }
    return result;
  }

  void require(bool condition) { valid_ = valid_ && condition; }
  bool complete() const { return valid_ && !left_; }
  const std::string& text() const { return text_; }

 private:
  std::string_view next() {
    valid_ = valid_ && left_;
    const auto comma = rest_.find(',');
    const std::string_view field = rest_.substr(0, comma);
    left_ = comma != std::string_view::npos;
    rest_ = left_ ? rest_.substr(comma + 1) : std::string_view{};
    return field;
  }

  std::string_view rest_;
  std::string text_;
  bool left_ = true;
  bool valid_ = true;
};

void read_output_speed_and_wait(Fields& fields, Instruction& line) {
  line.output = fields.small(0, 63);
  line.speed = fields.small(1, 4);
  line.wait_tenths = fields.small(0, kWaitMax);
}

// Reads tm, and after it ta and tv in the modes that have them (manual 114) (1)).
void read_trigger(Fields& fields, Instruction& line) {
  Trigger& trigger = line.trigger;
  trigger.mode = fields.small(0, Trigger::kAsBefore);
  if (trigger.mode >= Trigger::kOneShot) return;
  trigger.axis = fields.small(1, kAxes);
  if (trigger.mode == 1) {
    fields.require(trigger.axis == 1);
    trigger.interval = fields.number(1, kTriggerHundredthsMax);
    return;
  }
  const std::int64_t signed_interval = fields.number(trigger.mode == 0 ? 0 : -kTriggerPulsesMax, kTriggerPulsesMax);
  trigger.interval = signed_interval < 0 ? -signed_interval : signed_interval;
  fields.require(trigger.interval >= kTriggerMinimum);
}

void read_move(Fields& fields, Instruction& line) {
  line.axes = fields.axes();
  fields.require(line.pattern != Pattern::line || line.axes.count() >= 2);
  for (std::int64_t& value : line.values) value = fields.coordinate();
  read_output_speed_and_wait(fields, line);
  read_trigger(fields, line);
}

void read_continuous(Fields& fields, Instruction& line) {
  line.axes = fields.axes();
  fields.require(line.axes.count() == 1);
  for (std::int64_t& value : line.values) value = fields.coordinate();
  read_output_speed_and_wait(fields, line);
  line.trigger.mode = fields.small(0, 2);
  fields.require(line.trigger.mode != 1);
}

// Manual 114) (3) to (8). The shapes come in pairs, one for each direction of rotation.
void read_circle(Fields& fields, Instruction& line) {
  const bool helix = line.pattern == Pattern::helix;
  line.axes = fields.axes();
  fields.require(line.axes.count() == 2);
  const int mode = fields.small(0, 5);
  const int shape = mode / 2;
  Arc arc;
  arc.shape = helix ? shape + 3 : shape;
  arc.direction = mode % 2;
  for (int point = 0; point < (shape == 2 ? 4 : 2); ++point) arc.points.push_back(fields.coordinate());
  if (shape == 1) arc.angle = Number{fields.number(0, helix ? 360'000 : 360), 0};
  // Three points on a straight line do not form an arc (manual 73)).
  if (shape == 2) fields.require(arc.points[0] * arc.points[3] != arc.points[1] * arc.points[2]);
  if (helix) arc.points.push_back(fields.coordinate());
  if (helix && shape == 0) arc.turns = fields.small(1, 1000);
  line.arc = std::move(arc);
  read_output_speed_and_wait(fields, line);
  read_trigger(fields, line);
}

void read_return(Fields& fields, Instruction& line) {
  line.axes = fields.axes();
  line.output = fields.small(0, 63);
  if (line.pattern == Pattern::logical_return) line.speed = fields.small(1, 4);
  line.wait_tenths = fields.small(0, kWaitMax);
  line.trigger.mode = fields.small(Trigger::kOneShot, Trigger::kProhibited);
}

void read_set_origin(Fields& fields, Instruction& line) { line.axes = fields.axes(); }
void read_input(Fields& fields, Instruction& line) { line.inputs = fields.small(0, 63); }
void read_loop_end(Fields& fields, Instruction& line) { line.nest = fields.small(1, ProgramRun::kNests); }
void read_nothing(Fields&, Instruction&) {}

void read_loop_start(Fields& fields, Instruction& line) {
  read_loop_end(fields, line);
  line.repeats = fields.small(1, 65'535);
}

void read_registered(Fields& fields, Instruction& line, int numbers) {
  line.axes = fields.axes();
  line.values.fill(fields.number(1, 20));
  for (int number = 1; number < numbers; ++number) line.values[static_cast<std::size_t>(number)] = fields.number(1, 20);
  read_output_speed_and_wait(fields, line);
  read_trigger(fields, line);
}

// Manual 114) (9) has three registration numbers in its example and one in its format.
void read_registered_by_three(Fields& fields, Instruction& line) { read_registered(fields, line, kAxes); }
void read_registered_by_one(Fields& fields, Instruction& line) { read_registered(fields, line, 1); }

struct Form {
  std::string_view name;
  Pattern pattern;
  void (*read)(Fields& fields, Instruction& line);
};

constexpr std::array kForms = {
    Form{"M", Pattern::relative, read_move},
    Form{"A", Pattern::absolute, read_move},
    Form{"K", Pattern::line, read_move},
    Form{"CM", Pattern::continuous, read_continuous},
    Form{"CA", Pattern::continuous, read_continuous},
    Form{"E", Pattern::arc, read_circle},
    Form{"EH", Pattern::helix, read_circle},
    Form{"PAV", Pattern::registered, read_registered_by_three},
    Form{"PAV", Pattern::registered, read_registered_by_one},
    Form{"H", Pattern::origin_return, read_return},
    Form{"Z", Pattern::logical_return, read_return},
    Form{"R", Pattern::set_origin, read_set_origin},
    Form{"INPUT", Pattern::input, read_input},
    Form{"F", Pattern::loop_start, read_loop_start},
    Form{"N", Pattern::loop_end, read_loop_end},
    Form{"END", Pattern::end, read_nothing},
    Form{"NONE", Pattern::none, read_nothing},
};

Instruction end_line() {
  Instruction end;
  end.pattern = Pattern::end;
  end.text = "END";
  return end;
}

}  // namespace

std::optional<Instruction> read_instruction(std::string_view text) {
  for (const Form& form : kForms) {
    Fields fields(text);
    if (fields.name() != form.name) continue;
    Instruction line;
    line.pattern = form.pattern;
    form.read(fields, line);
    if (!fields.complete()) continue;
    line.text = fields.text();
    return line;
  }
  return std::nullopt;
}

Program::Program() { set(1, end_line()); }

Instruction Program::at(int line) const {
  const auto found = lines_.find(line);
  return found == lines_.end() ? Instruction{} : found->second;
}

void Program::set(int line, const Instruction& instruction) {
  if (instruction.pattern == Pattern::none) {
    lines_.erase(line);
  } else {
    lines_[line] = instruction;
  }
}

void Program::add_missing_end() {
  const bool ends =
      std::any_of(lines_.begin(), lines_.end(), [](const auto& entry) { return entry.second.pattern == Pattern::end; });
  const int last = lines_.empty() ? 0 : lines_.rbegin()->first;
  if (!ends && last < kLines) set(last + 1, end_line());
}

int Program::next_registered(int line) const {
  const auto found = lines_.lower_bound(line);
  return found == lines_.end() ? kLines + 1 : found->first;
}

void ProgramMode::power_on() {
  number = 1;
  reports_completion = reports_trigger = editing = false;
  edited = {};
  run = {};
  notices.clear();
}

void ProgramMode::tell(std::string_view notice) {
  if (notices.size() < kNoticesMax) notices.emplace_back(notice);
}

}  // namespace axisgate::shrc203::simulator
