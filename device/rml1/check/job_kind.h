// Distinguishes a job from G-code by how it begins: a mill that receives G-code hangs until it is switched off.
#pragma once

#include <cstddef>
#include <cstdint>

#include "device/rml1/language/characters.h"
#include "device/rml1/language/place.h"

namespace axisgate::rml1 {

// G-code begins with "%" or "(", or has a word of G, N or O, which are no commands of RML-1, behind nothing but
// comments and words that either may mean: T1, M3, F100. Everything else is a job.
class JobKind {
 public:
  enum class Verdict : std::uint8_t { nothing_yet, rml, g_code };

  // `c` is the next byte. Once decided, the verdict never changes; it is decided after kLongest bytes at the latest.
  Verdict take(char c);

  const Place& place() const { return word_; }  // of the G-code that was recognised

 private:
  enum class In : std::uint8_t { blanks, comment, letter, number };

  Verdict judge(char c);
  Verdict judge_behind_letter(char c);

  static constexpr std::size_t kLongest = 1 << 16;  // the comments of some programs draw a picture

  Place next_;  // of the next byte
  Place word_;  // of the last word's letter
  char letter_ = 0;
  In in_ = In::blanks;
  Verdict verdict_ = Verdict::nothing_yet;
};

}  // namespace axisgate::rml1
