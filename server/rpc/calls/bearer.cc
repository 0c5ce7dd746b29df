#include "server/rpc/calls/bearer.h"

#include <algorithm>
#include <cctype>

namespace axisgate::rpc {
namespace {

constexpr std::string_view kBearer = "bearer ";

}  // namespace

std::optional<std::string> token_in(const std::optional<std::string_view>& authorization) {
  if (!authorization) return std::nullopt;
  // The scheme's letter case does not count (RFC 9110, 11.1).
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  const bool bearer = std::ranges::equal(authorization->substr(0, kBearer.size()), kBearer, same);
  return std::string(bearer ? authorization->substr(kBearer.size()) : std::string_view{});
}

}  // namespace axisgate::rpc
