// Untrusted bytes, made fit for a log line, a page or a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace axisgate {

// Printable ASCII only: \r, \n, \\ and \xNN stand for the bytes that are not. At most `bytes_max` characters come out;
// a longer text is cut between two bytes of the original and ends in "...".
std::string escaped(std::string_view device_text, std::size_t bytes_max = 80);

}  // namespace axisgate
