// Frames on the line of a rotor. Each frame has eight bytes, and is answered by a frame with the same sequence number.
//
//   0xA5 | opcode | sequence number | payload, 4 bytes, highest first, signed | XOR of the seven bytes before
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::rotor {

enum class Opcode : std::uint8_t {
  identify = 0x01,  // answered with firmware << 24 | serial number
  status = 0x02,    // answered with position << 2 | origin found << 1 | busy
  move = 0x10,      // payload: target in pulses
  home = 0x11,      // the origin counts as not found until the rotor has found it
  stop = 0x12,
  jog = 0x13,  // payload: signed speed in pulses/s; runs until a stop; changes the speed of a running jog
};
// Bit that is set in the opcode of an answer. The answer to an opcode from 0x10 on has payload 0 if it was accepted,
// otherwise a Refusal.
inline constexpr std::uint8_t kAnswerBit = 0x80;

enum class Refusal : std::int32_t { busy = 1, out_of_range = 2, unknown = 3 };

// Largest position: positions have 30 bits.
inline constexpr std::int64_t kCountMax = (1 << 29) - 1;

// Returns the name for metrics, such as "MOVE".
std::string_view name(Opcode opcode);

struct Frame {
  std::uint8_t opcode = 0;
  std::uint8_t sequence = 0;
  std::int32_t payload = 0;

  friend bool operator==(const Frame&, const Frame&) = default;
};

std::string encode(const Frame& frame);
std::string hex(std::string_view bytes);  // returns "a5 10 03", for people

// A FrameParser finds frames in a stream of bytes. Garbage and incomplete frames do not damage the frames after them.
class FrameParser {
 public:
  // Returns the frame that ends with this byte; nullopt if none does.
  std::optional<Frame> feed(char byte);
  void forget() { bytes_.clear(); }

 private:
  std::string bytes_;  // empty, or begins with a sync byte
};

}  // namespace axisgate::rotor
