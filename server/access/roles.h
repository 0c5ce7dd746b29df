// What a caller may ask for, by kind of caller.
#pragma once

#include <optional>
#include <string_view>

namespace axisgate::server {

// Each may do what those before it may.
enum class Role {
  nobody,     // nothing
  observer,   // read everything but what the configuration keeps for higher roles, and stop
  operator_,  // move what the leases allow
  admin,      // what changes a controller for all, take-over, tokens, erasing names
};

// "observer", "operator", "admin"; "nobody" is none of them.
std::string_view name(Role role);
std::optional<Role> role_named(std::string_view name);

}  // namespace axisgate::server
