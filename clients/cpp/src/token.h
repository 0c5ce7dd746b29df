// The token of a lease as text, for a command that `axisctl lease run` starts.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::client {

// Environment variable with the token.
inline constexpr const char* kLeaseVariable = "AXISGATE_LEASE";

// Returns the bytes of a token in hexadecimal.
std::string token_text(std::string_view token);

// Returns the bytes of a token from its text. Throws InvalidArgument if the text is no token.
std::string token_bytes(std::string_view text);

}  // namespace axisgate::client
