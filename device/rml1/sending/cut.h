// Where a job may be cut in writes: a number that is cut in two would be executed as another one, if an abort came
// between.
#pragma once

#include <cstddef>
#include <string_view>

namespace axisgate::rml1 {

// The end of what is written next, from `begin` on: a command with the delimiters behind it. One that is longer than
// `window` is cut behind the comma of a complete set of coordinates, where it has one. `begin` is such an end, or 0.
std::size_t next_cut(std::string_view job, std::size_t begin, std::size_t window);

}  // namespace axisgate::rml1
