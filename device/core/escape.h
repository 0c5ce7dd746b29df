// Untrusted bytes in a form that is safe for a log line, a page or a terminal.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

// Returns printable ASCII only, with \r, \n, \\ and \xNN for other bytes. The result has at most `bytes_max`
// characters; a longer text is cut between two bytes of the original and ends in "...".
std::string escaped(std::string_view device_text, std::size_t bytes_max = 80);

// Returns the bytes between double quotes, never cut, with each quote written as \". take_quoted_bytes() restores every
// byte exactly.
std::string quoted_bytes(std::string_view bytes);

// Takes the output of quoted_bytes() off the front of `text`. Returns nullopt if the text does not begin with such
// output; `text` then begins at the first character that does not fit.
std::optional<std::string> take_quoted_bytes(std::string_view& text);

}  // namespace axisgate
