// Jobs of commands and numbers as they may come, some of them in error.
#pragma once

#include <random>
#include <string>

namespace axisgate::rml1 {

// Up to twelve commands. Only X and Y have fractions, no sum of which is half a step: that may be rounded either way,
// and a Z0 between two steps is an open question.
std::string random_job(std::mt19937& random);

}  // namespace axisgate::rml1
