#include "device/rml1/language/quoted.h"

#include <fmt/format.h>

namespace axisgate::rml1 {

std::string in_quotes(std::string_view bytes) {
  constexpr std::size_t kLongest = 24;
  std::string text = "\"";
  for (const char c : bytes.substr(0, kLongest)) {
    text += c >= 0x20 && c < 0x7F ? std::string(1, c) : fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
  }
  return text + (bytes.size() > kLongest ? "...\"" : "\"");
}

}  // namespace axisgate::rml1
