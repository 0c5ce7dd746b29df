// How many files the operating system lets this process open, and how many connections that leaves.
#pragma once

#include <cstddef>

namespace axisgate::server {

// Raises the limit as far as this process may and the daemon could use. Returns how many connections may be open.
std::size_t raise_descriptor_limit();

// At a limit of `descriptors`: what is left beside lines, files, the metrics page and the reserve, at most 4096.
std::size_t connections_within(std::size_t descriptors);

}  // namespace axisgate::server
