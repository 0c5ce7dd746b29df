#include "device/shrc203/simulator/axis_set.h"

#include <algorithm>

namespace axisgate::shrc203::simulator {
namespace {

struct Spelling {
  char letter;
  Axes axes;
};

constexpr std::array kCommandLetters = {Spelling{'1', {1}},      Spelling{'2', {2}},    Spelling{'3', {3}},
                                        Spelling{'A', {1, 2}},   Spelling{'B', {1, 3}}, Spelling{'C', {2, 3}},
                                        Spelling{'D', {1, 2, 3}}};

constexpr std::array kLimitLetters = {Spelling{'1', {1}},      Spelling{'2', {2}},    Spelling{'3', {3}},
                                      Spelling{'C', {1, 2}},   Spelling{'D', {1, 3}}, Spelling{'E', {2, 3}},
                                      Spelling{'W', {1, 2, 3}}};

constexpr std::array<Axes, 7> kSettings = {Axes{1},    Axes{2},    Axes{3},      Axes{1, 2},
                                           Axes{1, 3}, Axes{2, 3}, Axes{1, 2, 3}};

template <class Table>
char spell(const Table& table, Axes axes) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Spelling& s) { return s.axes == axes; });
  return found == table.end() ? '?' : found->letter;
}

}  // namespace

bool Axes::within(const Axes& other) const {
  return std::all_of(kAxisNumbers.begin(), kAxisNumbers.end(), [&](int a) { return !has(a) || other.has(a); });
}

bool Axes::touches(const Axes& other) const {
  return std::any_of(kAxisNumbers.begin(), kAxisNumbers.end(), [&](int a) { return has(a) && other.has(a); });
}

std::optional<Axes> axes_of_letter(char letter, Axes controllable) {
  if (letter == 'W') return controllable;
  for (const Spelling& spelling : kCommandLetters) {
    if (spelling.letter == letter && spelling.axes.within(controllable)) return spelling.axes;
  }
  return std::nullopt;
}

char letter_of(Axes axes) { return spell(kCommandLetters, axes); }

char limit_stop_letter(Axes axes) { return spell(kLimitLetters, axes); }

Axes axes_of_setting(int setting) { return kSettings.at(static_cast<std::size_t>(setting)); }

}  // namespace axisgate::shrc203::simulator
