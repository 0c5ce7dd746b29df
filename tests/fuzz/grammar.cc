#include "tests/fuzz/grammar.h"

#include <algorithm>
#include <array>
#include <random>
#include <string_view>

#include "device/rml1/language/instruction_table.h"

namespace axisgate::rml1 {
namespace {

using Dice = std::minstd_rand;

std::size_t below(Dice& dice, std::size_t count) { return dice() % count; }

template <class List>
auto pick(Dice& dice, const List& list) {
  return list[below(dice, std::size(list))];
}

std::string number(Dice& dice) {
  constexpr std::array<std::string_view, 16> kEdges = {"0",
                                                       "-0.5",
                                                       "1",
                                                       "32767",
                                                       "32768",
                                                       "-32768",
                                                       "-32769",
                                                       "8388607",
                                                       "8388608",
                                                       "-8388608",
                                                       "-8388609",
                                                       ".",
                                                       "-",
                                                       "99999999999999999999",
                                                       "0.00000000000000000001",
                                                       "+7"};
  if (below(dice, 3) == 0) return std::string(pick(dice, kEdges));
  return std::to_string(static_cast<int>(below(dice, 20'000)) - 10'000);
}

std::string command(Dice& dice) {
  constexpr std::array<std::string_view, 8> kBetween = {",", " ", "\t", ", ", " ,", ",,", "", ":"};
  constexpr std::array<std::string_view, 8> kEnds = {";", "\n", "\r\n", "", ";;", " ", "^", "\x1B.K"};
  const Row& row = pick(dice, guideline_rows());
  std::string text(row.name);
  if (row.takes == Takes::axes) {
    for (std::size_t axis = below(dice, 6); axis > 0; --axis) {
      text += static_cast<char>('W' + below(dice, 4));
      text += number(dice) + (below(dice, 3) == 0 ? ":" : "");
    }
  } else {
    for (std::size_t count = below(dice, 8); count > 0; --count)
      text += number(dice) + std::string(pick(dice, kBetween));
  }
  return text + std::string(pick(dice, kEnds));
}

}  // namespace

std::string mutated(std::string job, std::size_t longest, std::uint32_t seed) {
  Dice dice(seed);
  const std::size_t place = below(dice, job.size() + 1);
  switch (below(dice, 4)) {
    case 0:
      job.insert(place, command(dice));
      break;
    case 1:
      job.erase(place, below(dice, 16) + 1);
      break;
    case 2:
      job.insert(place, number(dice));
      break;
    default:
      job.insert(place, job.substr(below(dice, job.size() + 1), below(dice, 64)));
  }
  job.resize(std::min(job.size(), longest));
  return job;
}

}  // namespace axisgate::rml1
