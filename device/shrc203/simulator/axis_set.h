// Sets of axes 1 to 3 and the manual's letters for them, deliberately separate from the gateway's own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

namespace axisgate::shrc203::simulator {

inline constexpr int kAxes = 3;
inline constexpr std::array<int, kAxes> kAxisNumbers = {1, 2, 3};

inline constexpr std::size_t index_of(int axis) { return static_cast<std::size_t>(axis - 1); }

class Axes {
 public:
  constexpr Axes() = default;
  constexpr Axes(std::initializer_list<int> axes) {
    for (const int axis : axes) add(axis);
  }

  constexpr bool has(int axis) const { return member_[index_of(axis)]; }
  constexpr void add(int axis) { member_[index_of(axis)] = true; }
  constexpr void remove(int axis) { member_[index_of(axis)] = false; }
  constexpr bool empty() const { return count() == 0; }
  constexpr int count() const { return int{member_[0]} + int{member_[1]} + int{member_[2]}; }

  std::vector<int> list() const {
    std::vector<int> axes;
    for (const int axis : kAxisNumbers) {
      if (has(axis)) axes.push_back(axis);
    }
    return axes;
  }
  int lowest() const { return list().front(); }  // must not be called for an empty set

  bool within(const Axes& other) const;
  bool touches(const Axes& other) const;
  friend constexpr bool operator==(const Axes&, const Axes&) = default;

 private:
  std::array<bool, kAxes> member_{};
};

// Converts the `a` of a command: 1 2 3, A=1+2, B=1+3, C=2+3, D=all three, W=all controllable (manual 3) !:S and many
// others). nullopt for any other letter, and for a set with an axis outside `controllable`.
std::optional<Axes> axes_of_letter(char letter, Axes controllable);
char letter_of(Axes axes);

// Returns the letter of the status field in Q: and SRQ: (manual 4), 6)), where C=1+2, D=1+3, E=2+3 and W=all.
char limit_stop_letter(Axes axes);

// Converts the digit of ?:AXIS (manual 44)): 0 to 6.
Axes axes_of_setting(int setting);

}  // namespace axisgate::shrc203::simulator
