#include "device/core/escape.h"

namespace axisgate {
namespace {

constexpr std::string_view kCut = "...";

std::string escaped(char byte) {
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
  constexpr std::string_view kHexDigits = "0123456789ABCDEF";
  const auto value = static_cast<unsigned char>(byte);
  return {'\\', 'x', kHexDigits[value >> 4], kHexDigits[value & 15]};
}

}  // namespace

std::string escaped(std::string_view device_text, std::size_t bytes_max) {
  const std::string_view cut = kCut.substr(0, bytes_max);
  std::string text;
  std::size_t fits_with_cut = 0;
  for (const char byte : device_text) {
    text += escaped(byte);
    if (text.size() > bytes_max) return text.substr(0, fits_with_cut).append(cut);
    if (text.size() + cut.size() <= bytes_max) fits_with_cut = text.size();
  }
  return text;
}

}  // namespace axisgate
