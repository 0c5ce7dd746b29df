// The token in a call's headers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace axisgate::rpc {

// Returns the token from the value of `authorization`. nullopt without the header; an empty string if it is not a
// bearer token.
std::optional<std::string> token_in(const std::optional<std::string_view>& authorization);

}  // namespace axisgate::rpc
