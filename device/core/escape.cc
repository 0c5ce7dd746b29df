#include "device/core/escape.h"

namespace axisgate {
namespace {

constexpr std::string_view kCut = "...";

constexpr std::string_view kHexDigits = "0123456789ABCDEF";

std::string escaped_byte(char byte) {
  switch (byte) {
    case '\r':
      return "\\r";
    case '\n':
      return "\\n";
    case '\\':
      return "\\\\";
    default:
      break;
  }
  if (byte >= ' ' && byte <= '~') return std::string(1, byte);
  const auto value = static_cast<unsigned char>(byte);
  return {'\\', 'x', kHexDigits[value >> 4], kHexDigits[value & 15]};
}

// Takes one byte in the form that escaped() or quoted_bytes() writes.
std::optional<char> take_byte(std::string_view& text) {
  if (text.empty() || text[0] < ' ' || text[0] > '~') return {};
  const auto take = [&text](std::size_t characters, char byte) {
    text.remove_prefix(characters);
    return byte;
  };
  if (text[0] != '\\') return take(1, text[0]);
  if (text.size() < 2) return {};
  if (text[1] == 'r') return take(2, '\r');
  if (text[1] == 'n') return take(2, '\n');
  if (text[1] == '\\' || text[1] == '"') return take(2, text[1]);
  if (text[1] != 'x' || text.size() < 4) return {};
  const auto high = kHexDigits.find(text[2]), low = kHexDigits.find(text[3]);
  if (high == std::string_view::npos || low == std::string_view::npos) return {};
  return take(4, static_cast<char>(high << 4 | low));
}

}  // namespace

std::string escaped(std::string_view device_text, std::size_t bytes_max) {
  const std::string_view cut = kCut.substr(0, bytes_max);
  std::string text;
  std::size_t fits_with_cut = 0;
  for (const char byte : device_text) {
    text += escaped_byte(byte);
    if (text.size() > bytes_max) return text.substr(0, fits_with_cut).append(cut);
    if (text.size() + cut.size() <= bytes_max) fits_with_cut = text.size();
  }
  return text;
}

std::string quoted_bytes(std::string_view bytes) {
  std::string text = "\"";
  for (const char byte : bytes) text += byte == '"' ? "\\\"" : escaped_byte(byte);
  return text + '"';
}

std::optional<std::string> take_quoted_bytes(std::string_view& text) {
  if (!text.starts_with('"')) return {};
  text.remove_prefix(1);
  std::string bytes;
  while (!text.starts_with('"')) {
    const auto byte = take_byte(text);
    if (!byte) return {};
    bytes.push_back(*byte);
  }
  text.remove_prefix(1);
  return bytes;
}

}  // namespace axisgate
