// Bytes of a job as a message shows them.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::rml1 {

// In quotation marks; what is no printable ASCII as \xNN; at most 24 bytes, then "...".
std::string in_quotes(std::string_view bytes);

}  // namespace axisgate::rml1
