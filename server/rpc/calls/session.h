// Identification of the program that a call comes from.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace axisgate::rpc {

// Metadata key of a random value that a program makes once and sends over all of its connections.
inline constexpr const char* kSessionHeader = "axisgate-session";

// Returns the header if it is 8 to 64 letters, digits and hyphens. Otherwise returns the connection's name for an
// anonymous caller that only the connection identifies, and an empty string for any other caller.
std::string session_in(const std::optional<std::string_view>& header, const std::string& who);

}  // namespace axisgate::rpc
