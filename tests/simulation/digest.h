// Digest of everything sent over a line and of each motion's outcome. Two builds with equal digests for a seed did the
// same, byte by byte and at the same virtual times. FNV-1a, 64 bits.
#pragma once

#include <cstdint>
#include <string_view>

#include "device/core/time.h"

namespace axisgate::simulation {

class Digest {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) add_byte(static_cast<std::uint8_t>(byte));
    add_byte(0);
  }
  void add(std::uint64_t number) {
    for (int shift = 0; shift < 64; shift += 8) add_byte(static_cast<std::uint8_t>(number >> shift));
  }
  void add(TimePoint time) { add(static_cast<std::uint64_t>(time.time_since_epoch().count())); }
  std::uint64_t value() const { return value_; }

 private:
  void add_byte(std::uint8_t byte) { value_ = (value_ ^ byte) * 0x100000001B3u; }

  std::uint64_t value_ = 0xCBF29CE484222325u;
};

}  // namespace axisgate::simulation
