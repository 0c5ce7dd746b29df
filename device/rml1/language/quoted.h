// Bytes of a job in the form that messages show.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::rml1 {

// Returns the bytes in quotation marks, with \xNN for bytes that are not printable ASCII; at most 24 bytes, then "...".
std::string in_quotes(std::string_view bytes);

}  // namespace axisgate::rml1
