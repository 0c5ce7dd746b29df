#include "server/config/caller.h"

#include <algorithm>

#include "server/config/name.h"

namespace axisgate::server {

std::string wrong_with_caller(std::string_view who, std::string_view unknown) {
  const auto blank = who.find(' ');
  const std::string_view way = who.substr(0, blank);
  const std::string_view name = blank == std::string_view::npos ? "" : who.substr(blank + 1);
  if (way == "tcp") return "is known by an address only, which everybody on this machine may have";
  const bool known = way == "unix" || way == "cert" || way == "token";
  if (!known) return std::string(unknown);
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  if (name.empty() || name.front() == ' ' || name.back() == ' ' || !std::ranges::all_of(name, printable)) {
    return "names nobody";
  }
  if (way == "token" && !is_name(name)) return "is not a token's name";
  const bool login = name.find(' ') == std::string_view::npos || name.starts_with("uid ");
  return way == "unix" && !login ? "is not a login" : "";
}

}  // namespace axisgate::server
