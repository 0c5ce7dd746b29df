#include "server/access/roles.h"

#include <array>
#include <cstddef>

namespace axisgate::server {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"nobody", "observer", "operator", "admin"};  // by Role

}  // namespace

std::string_view name(Role role) { return kNames.at(static_cast<std::size_t>(role)); }

std::optional<Role> role_named(std::string_view name) {
  for (std::size_t i = 1; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Role>(i);
  }
  return std::nullopt;
}

}  // namespace axisgate::server
