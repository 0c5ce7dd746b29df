// Tells a job from G-code by its first bytes: a mill that gets G-code hangs until it is switched off.
#pragma once

#include <cstdint>

#include "device/rml1/place.h"

namespace axisgate::rml1 {

class JobKind {
 public:
  enum class Told : std::uint8_t { nothing_yet, rml, g_code };

  // `c` is the next byte. Once told, the same for ever.
  Told take(char c) {
    if (told_ != Told::nothing_yet) return told_;
    if (static_cast<unsigned char>(c) <= 0x20) {
      if (!letter_)
        place_ = c == '\n' ? Place{place_.offset + 1, place_.line + 1, 1}
                           : Place{place_.offset + 1, place_.line, place_.column + 1};
      return told_;
    }
    const bool digit = c >= '0' && c <= '9';
    if (letter_) {
      told_ = digit ? Told::g_code : Told::rml;
    } else if (c == '%' || c == '(') {
      told_ = Told::g_code;
    } else if ((c | 0x20) == 'g' || (c | 0x20) == 'n' || (c | 0x20) == 'o') {
      letter_ = true;  // G0, N10, O1000: no command of RML-1 begins with these letters
    } else {
      told_ = Told::rml;
    }
    return told_;
  }

  const Place& place() const { return place_; }  // of the first byte that is no blank

 private:
  Place place_;
  Told told_ = Told::nothing_yet;
  bool letter_ = false;
};

}  // namespace axisgate::rml1
