// Mutator that knows the instruction table; random bytes rarely form a command.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace axisgate::rml1 {

// Returns a variant of `job` of at most `longest` bytes. The same seed gives the same variant.
std::string mutated(std::string job, std::size_t longest, std::uint32_t seed);

}  // namespace axisgate::rml1
