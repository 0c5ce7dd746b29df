// Callers by name in the configuration.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::server {

// Why `who` cannot mean a caller; empty where it can. Only the very name that the daemon knows a caller by will do: any
// other would mean nobody. `unknown` is the answer for what begins with no way of calling. What is wrong follows on the
// name: "is not a login".
std::string wrong_with_caller(std::string_view who, std::string_view unknown);

}  // namespace axisgate::server
