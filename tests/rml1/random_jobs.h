// Random jobs of commands and numbers, some with errors.
#pragma once

#include <random>
#include <string>

namespace axisgate::rml1 {

// Returns up to twelve commands. Only X and Y have fractions, and no sum of them is half a step, which may be rounded
// up or down. Z has none, because a Z0 between two steps is an open question.
std::string random_job(std::mt19937& random);

}  // namespace axisgate::rml1
