// Distinguishes a job from G-code by its beginning: a mill that receives G-code hangs until it is switched off.
#pragma once

#include <cstddef>
#include <cstdint>

#include "device/jobs/place.h"
#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {

// G-code begins with "%" or "(", or with a word of G, N or O, which are not commands of RML-1. Comments and words that
// both languages have, such as T1, M3 and F100, may come before. Everything else is a job.
class JobKind {
 public:
  enum class Verdict : std::uint8_t { nothing_yet, rml, g_code };

  // Takes the next byte. The verdict comes after kLongest bytes at the latest, and then never changes.
  Verdict take(char c);

  const jobs::Place& place() const { return word_; }  // place of the G-code that was recognised

 private:
  enum class In : std::uint8_t { blanks, comment, letter, number };

  Verdict judge(char c);
  Verdict judge_after_letter(char c);

  static constexpr std::size_t kLongest = 1 << 16;  // the comments of some programs draw a picture

  jobs::Place next_;  // place of the next byte
  jobs::Place word_;  // place of the last word's letter
  char letter_ = 0;
  In in_ = In::blanks;
  Verdict verdict_ = Verdict::nothing_yet;
};

}  // namespace axisgate::rml1
