// A problem as one line for people.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

// What happened, then what to do.
inline std::string explain(const Problem& problem) {
  return problem.hint.empty() ? problem.message : problem.message + "; " + problem.hint;
}

}  // namespace axisgate::server
