// Tells a job from G-code by its first bytes: a mill that gets G-code hangs until it is switched off.
#pragma once

#include <cstdint>

#include "device/rml1/characters.h"
#include "device/rml1/place.h"

namespace axisgate::rml1 {

class JobKind {
 public:
  enum class Told : std::uint8_t { nothing_yet, rml, g_code };

  // `c` is the next byte. Once told, the same for ever.
  Told take(char c) {
    if (told_ != Told::nothing_yet) return told_;
    const bool blank = is_delimiter(c) || is_mark(c);
    if (blank && !letter_) {
      place_ = c == '\n' ? Place{place_.offset + 1, place_.line + 1, 1}
                         : Place{place_.offset + 1, place_.line, place_.column + 1};
      return told_;
    }
    if (letter_ && is_blank(c) && ++blanks_ <= kBlanks) return told_;
    if (letter_) {
      told_ = is_digit(c) ? Told::g_code : Told::rml;
    } else if (c == '%' || c == '(') {
      told_ = Told::g_code;
    } else if (begins_word(c)) {
      letter_ = true;
    } else {
      told_ = Told::rml;
    }
    return told_;
  }

  bool waits() const { return letter_; }         // for what stands behind a letter
  const Place& place() const { return place_; }  // of the first byte that is no blank

 private:
  // G0, N10, O1000: no command of RML-1 begins with these letters.
  static bool begins_word(char c) { return capital(c) == 'G' || capital(c) == 'N' || capital(c) == 'O'; }
  // Of the byte order mark that some editors put before a text.
  static bool is_mark(char c) { return c == '\xEF' || c == '\xBB' || c == '\xBF'; }

  Place place_;
  Told told_ = Told::nothing_yet;
  static constexpr int kBlanks = 8;  // between letter and digit
  bool letter_ = false;
  int blanks_ = 0;
};

}  // namespace axisgate::rml1
