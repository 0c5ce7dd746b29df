// Jobs at random, without an error in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace axisgate::rml1 {

// Commands of all kinds but H and IN, of `bytes` or a little more, within 15 mm of the work origin. The same for the
// same seed.
std::string random_mill_job(std::uint64_t seed, std::size_t bytes);

}  // namespace axisgate::rml1
