// Random jobs without errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace axisgate::rml1 {

// Returns commands of all kinds except H and IN, of `bytes` or slightly more, within 15 mm of the work origin. The same
// seed gives the same job.
std::string random_mill_job(std::uint64_t seed, std::size_t bytes);

}  // namespace axisgate::rml1
