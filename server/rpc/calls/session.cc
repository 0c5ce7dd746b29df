#include "server/rpc/calls/session.h"

#include <algorithm>
#include <cctype>

#include "server/access/access.h"

namespace axisgate::rpc {
namespace {

constexpr std::size_t kShortest = 8, kLongest = 64;

bool is_session(std::string_view text) {
  const auto good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-'; };
  return text.size() >= kShortest && text.size() <= kLongest && std::ranges::all_of(text, good);
}

}  // namespace

std::string session_in(const std::optional<std::string_view>& header, const std::string& who) {
  if (header && is_session(*header)) return std::string(*header);
  return server::names_connection(who) ? who : std::string();
}

}  // namespace axisgate::rpc
