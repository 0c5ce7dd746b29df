#include "device/shrc203/simulator/commands/memory_switch_commands.h"

#include <algorithm>
#include <array>

#include "device/shrc203/simulator/commands/reader.h"
#include "device/shrc203/simulator/commands/setters.h"

namespace axisgate::shrc203::simulator {
namespace {

// Modes as numbered by MODE SEL: the order of manual 37), in which MANUAL is the 1 of manual 119).
constexpr std::array<std::string_view, 6> kModesAtPowerOn = {"HOST", "MANUAL", "REMOTE", "TEACHING", "EDIT", "TEST"};

constexpr std::string_view kStageUnits = "PNUMD";                               // manual 5)
constexpr std::string_view kAxisNames = "123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";  // manual 12)

// Returns the text after MS: up to the first comma: SET, GETK and so on.
std::string_view word_of(std::string_view arguments) { return arguments.substr(0, arguments.find(',')); }

// Reads `,k,n`, or `,k` for the whole item if the word ends in K (manual 123) to 126)).
std::optional<SwitchRange> take_switches(Reader& reader, std::string_view word) {
  if (!reader.take(',')) return std::nullopt;
  const auto item = reader.take_integer(0, 8);
  const auto range = item ? switches_of_item(*item) : std::nullopt;
  if (!range || word.ends_with('K')) return range;
  if (!reader.take(',')) return std::nullopt;
  const auto number = reader.take_integer(0, static_cast<std::int64_t>(range->count) - 1);
  if (!number) return std::nullopt;
  return SwitchRange{range->first + static_cast<std::size_t>(*number), 1};
}

std::optional<std::int64_t> take_value(Reader& reader, const MemorySwitch& of) {
  if (!reader.take(',')) return std::nullopt;
  const int sign = reader.take_sign();
  const auto size = reader.take_integer(0, 999'999'999);
  if (!size || !of.takes(sign * *size)) return std::nullopt;
  return sign * *size;
}

Answer set(Rig& rig, Reader reader, const SwitchRange& range) {
  std::vector<std::int64_t> values;
  for (std::size_t i = 0; i < range.count; ++i) {
    const auto value = take_value(reader, memory_switches()[range.first + i]);
    if (!value) return Answer::ng;
    values.push_back(*value);
  }
  if (!reader.done()) return Answer::ng;
  for (std::size_t i = 0; i < range.count; ++i) rig.memory.edit(range.first + i, values[i]);
  return Answer::ok;
}

Answer initialize(Rig& rig, Reader reader, const SwitchRange& range) {
  if (!reader.done()) return Answer::ng;
  for (std::size_t i = 0; i < range.count; ++i) {
    rig.memory.edit(range.first + i, MemorySwitches::initial()[range.first + i]);
  }
  return Answer::ok;
}

Answer enter(Rig& rig) {
  if (rig.mode != "HOST" || rig.motions.busy(rig.controllable)) return Answer::ng;
  rig.memory.start_editing();
  rig.mode = kMemorySwitchMode;
  return Answer::ok;
}

Answer leave(Rig& rig) {
  rig.memory.save();
  rig.mode = "HOST";
  return Answer::ok;
}

Answer memory_switch(Rig& rig, Reader reader) {
  const std::string_view arguments = reader.rest();
  if (arguments == "ON") return enter(rig);
  if (rig.mode != kMemorySwitchMode) return Answer::ng;
  if (arguments == "OFF") return leave(rig);
  const std::string_view word = word_of(arguments);
  reader.take_text(word);
  const auto range = take_switches(reader, word);
  if (!range) return Answer::ng;
  if (word == "SET" || word == "SETK") return set(rig, reader, *range);
  if (word == "DEF" || word == "DEFK") return initialize(rig, reader, *range);
  return Answer::ng;
}

constexpr Command kCommand{"MS:", memory_switch};

Speed speed_saved(const MemorySwitches& memory, std::array<std::string_view, 3> names, int axis, int selection) {
  const std::int64_t maximum = memory.saved(names[1], axis, selection);
  // A saved S may exceed its F, which D: does not allow.
  return {std::min(memory.saved(names[0], axis, selection), maximum), maximum,
          static_cast<int>(memory.saved(names[2], axis, selection))};
}

void apply_to_axis(Rig& rig, int number) {
  const MemorySwitches& memory = rig.memory;
  Axis& axis = rig.axis(number);
  const auto selected = static_cast<int>(memory.saved("SPEED SEL"));
  axis.speed = speed_saved(memory, {"SPEED (S)", "SPEED (F)", "SPEED (R)"}, number, selected);
  axis.origin_speed = speed_saved(memory, {"ORG (S)", "ORG (F)", "ORG (R)"}, number, 0);
  axis.set_divide(memory.saved("DIVIDE", number));
  // A setup may have a pulse that no BASE RATE gives.
  axis.set_base(memory.as_built("BASE RATE", number)
                    ? rig.options.axes[index_of(number)].nm_per_pulse_e6 * Axis::kDefaultDivide
                    : memory.saved("BASE RATE", number) * 10'000'000);
  axis.open_loop = memory.saved("CONTROL", number) == 1;
  axis.configured = memory.saved("CONFIG", number) == 1;
  axis.excited_in_emergency = memory.saved("EMG MT EXCT", number) == 1;
  axis.name = kAxisNames[static_cast<std::size_t>(memory.saved("AXIS NAME", number))];
  axis.unit = kStageUnits[static_cast<std::size_t>(memory.saved("STAGE UNIT", number))];
}

}  // namespace

bool works_in_memory_switch_mode(std::string_view line) {
  return line == "*IDN?" || line.starts_with('?') || line == "BEEP?" || (line.starts_with("MS:") && line != "MS:ON");
}

bool is_memory_switch_question(std::string_view line) {
  if (!line.starts_with("MS:")) return false;
  const std::string_view word = word_of(line.substr(3));
  return word == "GET" || word == "GETK" || word == "DEFR" || word == "DEFRK";
}

std::optional<std::string> answer_memory_switch(const Rig& rig, std::string_view line) {
  if (rig.mode != kMemorySwitchMode) return std::nullopt;
  Reader reader(line.substr(3));
  const std::string_view word = word_of(reader.rest());
  reader.take_text(word);
  const auto range = take_switches(reader, word);
  if (!range || !reader.done()) return std::nullopt;
  const auto& values = word.starts_with("GET") ? rig.memory.edited() : MemorySwitches::initial();
  std::string text;
  for (std::size_t i = 0; i < range->count; ++i) {
    text += (i == 0 ? "" : ",") + std::to_string(values[range->first + i]);
  }
  return text;
}

const Command* find_memory_switch_command(std::string_view verb) { return verb == kCommand.verb ? &kCommand : nullptr; }

void apply_memory_switches(Rig& rig) {
  rig.axis_setting = static_cast<int>(rig.memory.saved("AXIS"));
  rig.controllable = axes_of_setting(rig.axis_setting);
  rig.mode = kModesAtPowerOn[static_cast<std::size_t>(rig.memory.saved("MODE SEL"))];
  rig.hit_format = rig.memory.saved("CMD FORMAT") == 1;
  rig.beep = rig.memory.saved("BEEP SEL") == 1;
  for (const int number : kAxisNumbers) apply_to_axis(rig, number);
}

}  // namespace axisgate::shrc203::simulator
