// The axes of a stage, and sets of them.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "device/use/scope.h"

namespace axisgate::stage {

// Highest number of axes of a stage. Kind::axis_count() is the number of one kind; the other axes of a State or Profile
// are not controllable.
inline constexpr int kAxesMax = 8;

// A set of axes, numbered from 1 to kAxesMax.
class AxisSet {
 public:
  constexpr AxisSet() = default;
  static constexpr AxisSet of(int axis) { return AxisSet(static_cast<std::uint8_t>(1u << (axis - 1))); }
  static constexpr AxisSet first(int count) { return AxisSet((1u << count) - 1); }  // axes 1 to `count`
  // Returns the axes of a scope of this stage.
  static constexpr AxisSet in(use::Scope scope) { return AxisSet(scope.axes()); }

  constexpr bool has(int axis) const { return (bits_ >> (axis - 1)) & 1u; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr int count() const { return std::popcount(bits_); }
  constexpr int lowest() const { return empty() ? 0 : std::countr_zero(bits_) + 1; }
  constexpr bool contains(AxisSet other) const { return (other.bits_ & ~bits_) == 0; }
  constexpr bool touches(AxisSet other) const { return (other.bits_ & bits_) != 0; }
  std::vector<int> list() const { return use::Scope(*this).list(); }  // ascending

  constexpr operator use::Scope() const { return use::Scope::of_axes(bits_); }  // NOLINT(google-explicit-constructor)

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

inline std::string to_string(AxisSet axes) { return use::to_string(axes); }  // "axis 1", "axes 1 and 3", "no axis"

}  // namespace axisgate::stage
