// Names of callers in the configuration.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::server {

// Returns the reason why `who` cannot be a caller, as text to follow the name: "is not a login". Empty if it can. Only
// the exact name by which the daemon identifies a caller is accepted; any other would match nobody. Returns `unknown`
// if the name does not begin with a known identification such as "unix".
std::string wrong_with_caller(std::string_view who, std::string_view unknown);

}  // namespace axisgate::server
