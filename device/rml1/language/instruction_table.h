// Table of all instructions of RML-1: each row has the parameters and the effects of one instruction (guideline 1-2, 3,
// 5-3).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {

enum class Operation : std::uint8_t {
  plot,          // D I M R PA PR PU PD: the tool up or down, then X and Y
  feed,          // Z !ZZ: three axes at once
  extension,     // !ZE: any axes at once
  home,          // H
  initialize,    // IN
  defaults,      // DF
  plane_speed,   // F VS
  height_speed,  // V !VZ
  dwell,         // W !DW
  heights,       // @ !PZ
  spindle,       // !MC
  revolutions,   // !RC
  pause,         // !NR
  height,        // !ZM
  surface,       // !ZO
  // : handled by the parser.
  call,
  ignored,  // beyond the guideline, and without effect
};

// Mode that a command leaves in effect (guideline 5-3).
enum class Coordinates : std::uint8_t { kept, absolute, relative };
enum class Tool : std::uint8_t { kept, raised, lowered };

enum class Takes : std::uint8_t {
  nothing,
  up_to,  // at most `count` numbers
  sets,   // any number of sets of `count` numbers
  axes,   // letters with numbers (3-3 !ZE)
};

// Ranges of the types int and long, and of float (guideline 2-3).
inline constexpr double kIntLowest = -32768, kIntHighest = 32767;
inline constexpr double kLongLowest = -8388608, kLongHighest = 8388607;

struct Parameter {
  bool whole = false;  // a fraction is ignored
  double lowest = kLongLowest, highest = kLongHighest;
  // True: a value beyond this limit is error 3. False: the limit itself is used instead (2-3, 2-5).
  bool lowest_stated = false, highest_stated = false;
};

struct Row {
  std::string_view name;  // one letter or symbol, two letters, or ! and two letters; in capitals
  Operation operation = Operation::ignored;
  std::string_view section;
  Takes takes = Takes::nothing;
  std::uint8_t count = 0;
  Coordinates coordinates = Coordinates::kept;
  Tool tool = Tool::kept;
  std::array<Parameter, 4> parameters = {};  // parameters of a set, or of the command
  bool beyond_guideline = false;
};

std::span<const Row> guideline_rows();
// Returns the row of an instruction beyond the guideline that some machines take: "J" (tool change), "!" (0 or 1: the
// spindle, an old form).
const Row& tolerated_row(std::string_view name);

// Finds rows by their letters, in either case.
class InstructionTable {
 public:
  InstructionTable(std::span<const Row> rows, std::span<const Row> more = {});

  const Row* one_letter(char symbol) const { return at(letters_, static_cast<unsigned char>(symbol)); }
  const Row* two_letters(char first, char second) const { return at(pairs_, index(first, second)); }
  const Row* common(char first, char second) const { return at(common_, index(first, second)); }
  bool begins_pair(char letter) const { return begins_pair_[letter_index(letter)]; }

 private:
  static std::size_t letter_index(char letter) { return static_cast<std::size_t>(capital(letter) - 'A'); }
  static std::size_t index(char first, char second) { return letter_index(first) * 26 + letter_index(second); }
  template <class Places>
  const Row* at(const Places& places, std::size_t where) const {
    return places[where] == 0 ? nullptr : &rows_[places[where] - 1u];
  }

  std::vector<Row> rows_;
  // Index of the row plus one; 0: none.
  std::array<std::uint8_t, 256> letters_{};
  std::array<std::uint8_t, 26 * 26> pairs_{}, common_{};
  std::array<bool, 26> begins_pair_{};
};

}  // namespace axisgate::rml1
