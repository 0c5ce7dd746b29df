// The operating system's limit of open files, and the number of connections within it.
#pragma once

#include <cstddef>

namespace axisgate::server {

// Raises the limit as far as permitted and useful. Returns the number of connections that may be open.
std::size_t raise_descriptor_limit();

// Returns the number of connections within a limit of `descriptors`, after those for lines, files, the metrics page and
// the reserve; at most 4096.
std::size_t connections_within(std::size_t descriptors);

}  // namespace axisgate::server
