// A mutator that knows the instruction table: bytes at random hardly ever make a command.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace axisgate::rml1 {

// A job near `job`, of at most `longest` bytes; the same for the same seed.
std::string mutated(std::string job, std::size_t longest, std::uint32_t seed);

}  // namespace axisgate::rml1
