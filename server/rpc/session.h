// Which program a call comes from.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace axisgate::rpc {

// In the metadata of a call: a random value that a program makes once and sends over all of its connections.
inline constexpr const char* kSessionHeader = "axisgate-session";

// What the header says, where it is 8 to 64 letters, digits and hyphens. Without one a caller whom nothing but the
// connection names is that connection, and another caller is unknown (empty).
std::string session_in(const std::optional<std::string_view>& header, const std::string& who);

}  // namespace axisgate::rpc
