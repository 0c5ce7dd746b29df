// Checks of conditions that hold for every input of a fuzzer.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <source_location>

namespace axisgate {

// Ends the program and prints the source location if the condition is false.
inline void require(bool holds, std::source_location where = std::source_location::current()) {
  if (holds) return;
  std::fprintf(stderr, "%s:%u does not hold\n", where.file_name(), static_cast<unsigned>(where.line()));
  std::abort();
}

}  // namespace axisgate
