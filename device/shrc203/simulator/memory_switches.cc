#include "device/shrc203/simulator/memory_switches.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "device/shrc203/simulator/axis_set.h"
#include "device/shrc203/simulator/commands/setters.h"

namespace axisgate::shrc203::simulator {
namespace {

constexpr std::int64_t kPulsesMax = 999'999'999;    // manual 45)
constexpr std::int64_t kBaseRateMax = 100'000'000;  // in units of 10 nm
constexpr int kSpeedNumbers = 4;

using Initial = std::int64_t (*)(const Options& options, int axis);

template <std::int64_t value>
std::int64_t always(const Options&, int) {
  return value;
}

template <auto member>
std::int64_t setup(const Options& options, int axis) {
  return options.axes[index_of(axis)].*member;
}

std::int64_t axis_setting(const Options& options, int) { return options.axis_setting; }
std::int64_t own_number(const Options&, int axis) { return axis - 1; }

std::int64_t emergency_excitation(const Options& options, int) {
  return options.is("emergency_excitation", "on") ? 1 : 0;
}

// Manual 10): a pulse is BASE RATE * 10 / DIVIDE nanometres; the pulses of the setup are those of DIVIDE 200.
std::int64_t base_rate(const Options& options, int axis) {
  const std::int64_t rate = (options.axes[index_of(axis)].nm_per_pulse_e6 * 20 + 500'000) / 1'000'000;
  return std::clamp<std::int64_t>(rate, 1, kBaseRateMax);
}

struct Row {
  std::string_view name;
  std::int64_t minimum;
  std::int64_t maximum;
  Initial initial;
  bool (*allowed)(std::int64_t value) = nullptr;
};

enum class Repeat { once, each_axis, each_speed_and_axis };

// Consecutive rows that are repeated together.
struct Block {
  std::int64_t item;
  Repeat repeat;
  std::vector<Row> rows;
};

// GENERAL is as listed in manual 122) to 126). For the other items the manual gives only the names that it uses
// elsewhere, and one number: SPEED12 (S) is 4 of SPEED (manual 119)). A public client sets one value of each axis by
// the numbers 9, 12 and 15 of ORG. The rest of the order is an interpretation, and so are the switches of INTERFACE,
// SENSOR, FEEDBACK and SOFT LIMIT and the first three of ORG (README.md).
std::vector<Block> blocks() {
  using A = AxisSetup;
  return {
      {0,
       Repeat::once,
       {{"AXIS", 0, 6, axis_setting},
        {"MODE SEL", 0, 5, always<0>},
        {"SLEEP SEL", 0, 1, always<1>},
        {"BEEP SEL", 0, 1, always<1>},
        {"JOG X SEL", 0, 2, always<0>},
        {"JOG Y SEL", 0, 2, always<1>},
        {"CMD FORMAT", 0, 1, always<0>},
        {"TRG / LEV", 0, 1, always<0>},
        {"TRG WIDTH", 0, 9, always<0>}}},
      {1, Repeat::once, {{"RATE", 0, 3, always<3>}, {"HANDSHAKE", 0, 1, always<1>}}},
      {2, Repeat::each_axis, {{"LIMIT", 0, 1, always<0>}}},
      {2, Repeat::each_axis, {{"ORIGIN", 0, 1, always<0>}}},
      {3, Repeat::each_axis, {{"AXIS NAME", 0, 34, own_number}}},
      {3, Repeat::each_axis, {{"STAGE UNIT", 0, 4, always<2>}}},
      {3, Repeat::each_axis, {{"BASE RATE", 1, kBaseRateMax, base_rate}}},
      {3, Repeat::each_axis, {{"CONFIG", 0, 1, always<0>}}},
      {3, Repeat::each_axis, {{"EMG MT EXCT", 0, 1, emergency_excitation}}},
      {4, Repeat::each_axis, {{"DIVIDE", 1, 8000, always<200>, is_division}}},
      {5, Repeat::once, {{"SPEED SEL", 0, kSpeedNumbers - 1, always<0>}}},
      {5,
       Repeat::each_speed_and_axis,
       {{"SPEED (S)", 1, kSpeedMax, setup<&A::minimum_speed>},
        {"SPEED (F)", 1, kSpeedMax, setup<&A::maximum_speed>},
        {"SPEED (R)", 1, kRampMax, setup<&A::acceleration_ms>}}},
      {6, Repeat::each_axis, {{"ORG METHOD", 0, kPulsesMax, always<0>}}},
      {6, Repeat::each_axis, {{"ORG DIRECTION", 0, kPulsesMax, always<0>}}},
      {6, Repeat::each_axis, {{"ORG OFFSET", -kPulsesMax, kPulsesMax, always<0>}}},
      {6,
       Repeat::each_axis,
       {{"ORG (S)", 1, kSpeedMax, setup<&A::origin_minimum_speed>},
        {"ORG (F)", 1, kSpeedMax, setup<&A::origin_maximum_speed>},
        {"ORG (R)", 1, kRampMax, setup<&A::origin_acceleration_ms>}}},
      {7, Repeat::each_axis, {{"CONTROL", 0, 1, always<1>}}},
      {8, Repeat::each_axis, {{"SOFT LIMIT", 0, 1, always<0>}}},
      {8, Repeat::each_axis, {{"SOFT LIMIT PLUS", -kPulsesMax, kPulsesMax, always<kPulsesMax>}}},
      {8, Repeat::each_axis, {{"SOFT LIMIT MINUS", -kPulsesMax, kPulsesMax, always<-kPulsesMax>}}},
  };
}

struct Table {
  std::vector<MemorySwitch> switches;
  std::vector<Initial> initials;
};

Table make_table() {
  Table table;
  for (const Block& block : blocks()) {
    for (int selection = 0; selection < (block.repeat == Repeat::each_speed_and_axis ? kSpeedNumbers : 1);
         ++selection) {
      for (int axis = 1; axis <= (block.repeat == Repeat::once ? 1 : kAxes); ++axis) {
        for (const Row& row : block.rows) {
          const int of_axis = block.repeat == Repeat::once ? 0 : axis;
          table.switches.push_back({block.item, row.name, of_axis, selection, row.minimum, row.maximum, row.allowed});
          table.initials.push_back(row.initial);
        }
      }
    }
  }
  return table;
}

const Table& table() {
  static const Table made = make_table();
  return made;
}

MemorySwitches::Values values_of(const Options& options) {
  MemorySwitches::Values values;
  for (std::size_t i = 0; i < table().switches.size(); ++i) {
    values.push_back(table().initials[i](options, table().switches[i].axis));
  }
  return values;
}

std::size_t place_of(std::string_view name, int axis, int selection) {
  const auto& all = table().switches;
  const auto found = std::find_if(all.begin(), all.end(), [&](const MemorySwitch& each) {
    return each.name == name && each.axis == axis && each.selection == selection;
  });
  if (found == all.end()) throw std::logic_error("no memory switch " + std::string(name));
  return static_cast<std::size_t>(found - all.begin());
}

}  // namespace

std::span<const MemorySwitch> memory_switches() { return table().switches; }

std::optional<SwitchRange> switches_of_item(std::int64_t item) {
  const auto& all = table().switches;
  const auto of_item = [item](const MemorySwitch& each) { return each.item == item; };
  const auto first = std::find_if(all.begin(), all.end(), of_item);
  if (first == all.end()) return std::nullopt;
  return SwitchRange{static_cast<std::size_t>(first - all.begin()),
                     static_cast<std::size_t>(std::count_if(first, all.end(), of_item))};
}

MemorySwitches::MemorySwitches(const Options& options) : built_(values_of(options)), saved_(built_), edited_(built_) {}

std::int64_t MemorySwitches::saved(std::string_view name, int axis, int selection) const {
  return saved_[place_of(name, axis, selection)];
}

bool MemorySwitches::as_built(std::string_view name, int axis) const {
  const std::size_t place = place_of(name, axis, 0);
  return saved_[place] == built_[place];
}

const MemorySwitches::Values& MemorySwitches::initial() {
  static const Values values = values_of(Options());
  return values;
}

}  // namespace axisgate::shrc203::simulator
