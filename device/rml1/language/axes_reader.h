// Reads the groups of !ZE byte by byte (guideline 3-3).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/instruction.h"
#include "device/rml1/language/number_reader.h"

namespace axisgate::rml1 {

class AxesReader {
 public:
  AxesReader(const std::vector<std::string>& apart, Diagnostics& diagnostics)
      : apart_(apart), diagnostics_(diagnostics) {}

  enum class Found : std::uint8_t {
    nothing,  // no complete group yet
    group,    // a group is complete: targets()
    last,     // a group is complete, and the command ends
    end,      // the command ends without another group
  };
  void begin();
  Found take(char c, const jobs::Place& place);
  std::span<const AxisTarget> targets() const { return {targets_.data(), count_}; }

 private:
  enum class State : std::uint8_t { letter, value, number, skip };

  Found letter(char c, const jobs::Place& place);
  void end_number();
  void fail(int number, const jobs::Place& place, std::string_view why);
  bool move_apart(char letter) const;

  const std::vector<std::string>& apart_;
  Diagnostics& diagnostics_;
  State state_ = State::letter;
  bool group_ended_ = false;  // the next letter begins a new group
  NumberReader number_;
  jobs::Place number_place_;
  AxisTarget target_;
  std::array<AxisTarget, 26> targets_{};
  std::size_t count_ = 0;
};

}  // namespace axisgate::rml1
