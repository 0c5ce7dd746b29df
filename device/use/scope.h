// Scope of a lease, a latch or a right: some axes of a stage, or a whole device.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace axisgate::use {

// A Scope is a set of axes, or the whole device if its parts cannot be used one by one, as those of a mill. The scopes
// of one device are all of one of these two forms.
class Scope {
 public:
  constexpr Scope() = default;  // nothing
  static constexpr Scope whole_device() { return Scope(kWholeDevice); }
  // Bit n of `bits` is axis n + 1.
  static constexpr Scope of_axes(std::uint32_t bits) { return Scope(bits & ~kWholeDevice); }

  constexpr bool is_whole_device() const { return bits_ == kWholeDevice; }
  constexpr std::uint32_t axes() const { return bits_ & ~kWholeDevice; }
  std::vector<int> list() const;  // axes, ascending; empty for a whole device

  constexpr bool empty() const { return bits_ == 0; }
  constexpr bool contains(Scope other) const { return (other.bits_ & ~bits_) == 0; }
  constexpr bool touches(Scope other) const { return (other.bits_ & bits_) != 0; }

  friend constexpr Scope operator|(Scope a, Scope b) { return Scope(a.bits_ | b.bits_); }
  friend constexpr Scope operator&(Scope a, Scope b) { return Scope(a.bits_ & b.bits_); }
  friend constexpr Scope operator-(Scope a, Scope b) { return Scope(a.bits_ & ~b.bits_); }
  friend constexpr bool operator==(Scope, Scope) = default;

 private:
  static constexpr std::uint32_t kWholeDevice = 1u << 31;

  constexpr explicit Scope(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

std::string to_string(Scope scope);  // "axis 1", "axes 1 and 3", "the whole device", "no axis", for people

}  // namespace axisgate::use
