// Hints of the API in the terms of this package.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace axisgate::client {

// Returns the hint with each call of the API replaced by a function of this package.
std::string with_functions(std::string_view hint, std::optional<int> axis);

}  // namespace axisgate::client
