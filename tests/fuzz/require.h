// A fuzzer states here what holds for every input.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <source_location>

namespace axisgate {

// Ends the program and names the place, where it does not.
inline void require(bool holds, std::source_location where = std::source_location::current()) {
  if (holds) return;
  std::fprintf(stderr, "%s:%u does not hold\n", where.file_name(), static_cast<unsigned>(where.line()));
  std::abort();
}

}  // namespace axisgate
