#include "tests/double/frame.h"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::rotor {
namespace {

constexpr char kSync = '\xA5';
constexpr std::size_t kFrameBytes = 8;

char sum(std::string_view bytes) {
  char all = 0;
  for (const char byte : bytes) all = static_cast<char>(all ^ byte);
  return all;
}

}  // namespace

std::string_view name(Opcode opcode) {
  switch (opcode) {
    case Opcode::identify:
      return "IDENTIFY";
    case Opcode::status:
      return "STATUS";
    case Opcode::move:
      return "MOVE";
    case Opcode::home:
      return "HOME";
    case Opcode::stop:
      return "STOP";
    case Opcode::jog:
      return "JOG";
  }
  return "UNKNOWN";
}

std::string encode(const Frame& frame) {
  std::string bytes{kSync, static_cast<char>(frame.opcode), static_cast<char>(frame.sequence)};
  const auto payload = static_cast<std::uint32_t>(frame.payload);
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(payload >> shift & 0xFFu);
  return bytes + sum(bytes);
}

std::string hex(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) {
    text += fmt::format("{}{:02x}", text.empty() ? "" : " ", static_cast<unsigned char>(byte));
  }
  return text;
}

std::optional<Frame> FrameParser::feed(char byte) {
  bytes_ += byte;
  // A payload may also contain the sync byte, so bytes with a wrong checksum may contain the beginning of the real
  // frame.
  if (bytes_.size() == kFrameBytes && sum(bytes_) != 0) bytes_.erase(0, 1);
  bytes_.erase(0, std::min(bytes_.find(kSync), bytes_.size()));
  if (bytes_.size() < kFrameBytes) return {};
  const auto at = [this](std::size_t place) { return static_cast<std::uint8_t>(bytes_[place]); };
  std::uint32_t payload = 0;
  for (std::size_t place = 3; place < 7; ++place) payload = payload << 8 | at(place);
  const Frame frame{at(1), at(2), static_cast<std::int32_t>(payload)};
  bytes_.clear();
  return frame;
}

}  // namespace axisgate::rotor
