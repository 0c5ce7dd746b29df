// The token of a call.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace axisgate::rpc {

// In the value of `authorization`; nothing without one, empty text where that is something else.
std::optional<std::string> token_in(const std::optional<std::string_view>& authorization);

}  // namespace axisgate::rpc
