// Untrusted bytes, made fit for a log line, a page or a terminal.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

// Printable ASCII only: \r, \n, \\ and \xNN stand for the bytes that are not. At most `bytes_max` characters come out;
// a longer text is cut between two bytes of the original and ends in "...".
std::string escaped(std::string_view device_text, std::size_t bytes_max = 80);

// Between double quotes, never cut, and a quote written \": the way back is exact for every byte.
std::string quoted_bytes(std::string_view bytes);

// Takes what quoted_bytes() has written off the front of `text`. Nothing where that is not what stands there; `text`
// then begins at the first character that cannot be.
std::optional<std::string> take_quoted_bytes(std::string_view& text);

}  // namespace axisgate
