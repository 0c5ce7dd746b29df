// Roles of callers.
#pragma once

#include <optional>
#include <string_view>

namespace axisgate::server {

// Roles in ascending order; each includes the rights of the roles before it.
enum class Role {
  nobody,     // no rights
  observer,   // reads everything, except what the configuration keeps for higher roles, and stops
  operator_,  // moves axes as the leases allow
  admin,      // changes a controller for all callers, takes over, manages tokens, erases names
};

// Role names are "observer", "operator" and "admin". role_named() does not accept "nobody".
std::string_view name(Role role);
std::optional<Role> role_named(std::string_view name);

}  // namespace axisgate::server
