// The line of a rotor: frames of eight bytes, each answered by one with the same sequence number.
//
//   0xA5 | opcode | sequence number | payload, 4 bytes, highest first, signed | XOR of the seven before
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::rotor {

enum class Opcode : std::uint8_t {
  identify = 0x01,  // answered with firmware << 24 | serial number
  status = 0x02,    // answered with position << 2 | origin found << 1 | busy
  move = 0x10,      // to the payload, in pulses
  home = 0x11,      // the origin counts as not found until it is
  stop = 0x12,
  jog = 0x13,  // at the payload in pulses/s, either way, until a stop; at another speed where it jogs
};
// What was asked is answered with this bit set. 0x10 and above: payload 0 is accepted, else one of Refusal.
inline constexpr std::uint8_t kAnswerBit = 0x80;

enum class Refusal : std::int32_t { busy = 1, out_of_range = 2, unknown = 3 };

// A position has 30 bits.
inline constexpr std::int64_t kCountMax = (1 << 29) - 1;

// "MOVE", as metrics have it.
std::string_view name(Opcode opcode);

struct Frame {
  std::uint8_t opcode = 0;
  std::uint8_t sequence = 0;
  std::int32_t payload = 0;

  friend bool operator==(const Frame&, const Frame&) = default;
};

std::string encode(const Frame& frame);
std::string hex(std::string_view bytes);  // "a5 10 03", for people

// Fed byte by byte. Garbage, and frames cut short, cost only themselves.
class FrameParser {
 public:
  // The frame that ends with this byte.
  std::optional<Frame> feed(char byte);
  void forget() { bytes_.clear(); }

 private:
  std::string bytes_;  // empty, or begins with a sync byte
};

}  // namespace axisgate::rotor
