// Axes, and the three alphabets in which the controller writes sets of them. No letter converts to another alphabet's.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::shrc203 {

inline constexpr int kAxisCount = 3;

// A set of axes 1..3.
class AxisSet {
 public:
  constexpr AxisSet() = default;
  static constexpr AxisSet of(int axis) { return AxisSet(static_cast<std::uint8_t>(1u << (axis - 1))); }
  static constexpr AxisSet all() { return AxisSet(7); }

  constexpr bool has(int axis) const { return (bits_ >> (axis - 1)) & 1u; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr int count() const { return (bits_ & 1) + ((bits_ >> 1) & 1) + ((bits_ >> 2) & 1); }
  constexpr int lowest() const { return has(1) ? 1 : has(2) ? 2 : has(3) ? 3 : 0; }
  constexpr bool contains(AxisSet other) const { return (other.bits_ & ~bits_) == 0; }
  constexpr bool touches(AxisSet other) const { return (other.bits_ & bits_) != 0; }
  std::vector<int> list() const;  // ascending

  constexpr void add(int axis) { bits_ |= of(axis).bits_; }
  constexpr void remove(int axis) { bits_ &= static_cast<std::uint8_t>(~of(axis).bits_); }

  friend constexpr AxisSet operator|(AxisSet a, AxisSet b) { return AxisSet(a.bits_ | b.bits_); }
  friend constexpr AxisSet operator&(AxisSet a, AxisSet b) { return AxisSet(a.bits_ & b.bits_); }
  friend constexpr AxisSet operator-(AxisSet a, AxisSet b) { return AxisSet(a.bits_ & ~b.bits_); }
  friend constexpr bool operator==(AxisSet, AxisSet) = default;

 private:
  constexpr explicit AxisSet(unsigned bits) : bits_(static_cast<std::uint8_t>(bits)) {}
  std::uint8_t bits_ = 0;
};

std::string to_string(AxisSet axes);  // "axis 1", "axes 1 and 3", "no axis", for people

// Commands: 1 2 3, A=1+2, B=1+3, C=2+3, D=1+2+3 (manual 3) and everywhere an `a` is sent). W is "all controllable axes"
// and depends on the unit, so the gateway never sends it. command_letter wants at least one axis.
char command_letter(AxisSet axes);
std::optional<AxisSet> from_command_letter(char letter, AxisSet controllable);

// The status field s of Q: and SRQ: (manual 4), 6)): 1 2 3, C=1+2, D=1+3, E=2+3, W=all; nothing for K, R and the rest.
std::optional<AxisSet> from_status_letter(char letter);

// ?:AXIS (manual 44)): 0 to 6.
std::optional<AxisSet> from_axis_setting(std::string_view digit);

}  // namespace axisgate::shrc203
