#include "clients/cpp/src/token.h"

#include <fmt/format.h>

#include <charconv>

#include "axisgate/errors.h"

namespace axisgate::client {
namespace {

constexpr std::size_t kTokenBytes = 24;

}  // namespace

std::string token_text(std::string_view token) {
  std::string text;
  for (const char byte : token) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

std::string token_bytes(std::string_view text) {
  std::string token;
  for (std::size_t at = 0; at + 2 <= text.size(); at += 2) {
    unsigned char byte = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + 2, byte, 16);
    if (error == std::errc() && end == text.data() + at + 2) token += static_cast<char>(byte);
  }
  if (token.size() != kTokenBytes || text.size() != 2 * kTokenBytes) {
    throw InvalidArgument(
        fmt::format("{} is not the token of a lease: unset it, or use `axisctl lease run`", kLeaseVariable));
  }
  return token;
}

}  // namespace axisgate::client
