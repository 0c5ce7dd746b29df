// The memory switches, which the controller keeps without power and applies at power-on (manual 117) to 126)).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "device/shrc203/simulator/options.h"

namespace axisgate::shrc203::simulator {

struct MemorySwitch {
  std::int64_t item = 0;  // k of manual 119): 0 GENERAL to 8 SOFT LIMIT
  std::string_view name;
  int axis = 0;       // 0: the whole controller
  int selection = 0;  // speed number of SPEED SEL to which it belongs, from 0
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  bool (*allowed)(std::int64_t value) = nullptr;  // null if every value in the range is allowed

  bool takes(std::int64_t value) const {
    return value >= minimum && value <= maximum && (allowed == nullptr || allowed(value));
  }
};

// Returns all switches, item by item. Within an item they are in the order of the content number n, which counts from
// 0.
std::span<const MemorySwitch> memory_switches();

// A range of consecutive switches in memory_switches().
struct SwitchRange {
  std::size_t first = 0;
  std::size_t count = 0;
};
std::optional<SwitchRange> switches_of_item(std::int64_t item);

class MemorySwitches {
 public:
  using Values = std::vector<std::int64_t>;

  // Sets the switches to the values of `options`.
  explicit MemorySwitches(const Options& options);

  std::int64_t saved(std::string_view name, int axis = 0, int selection = 0) const;
  bool as_built(std::string_view name, int axis) const;  // the saved value is that of the options

  void start_editing() { edited_ = saved_; }
  void save() { saved_ = edited_; }
  const Values& edited() const { return edited_; }
  void edit(std::size_t place, std::int64_t value) { edited_[place] = value; }

  static const Values& initial();  // values that MS:DEF sets and MS:DEFR reports

 private:
  Values built_;
  Values saved_;
  Values edited_;
};

}  // namespace axisgate::shrc203::simulator
