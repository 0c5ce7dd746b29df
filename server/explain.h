// A problem as one line for people.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

// What happened, then what to do, as one sentence or, where the hint begins with a capital, as two.
inline std::string explain(const Problem& problem) {
  if (problem.hint.empty()) return problem.message;
  const bool sentence = problem.hint.front() >= 'A' && problem.hint.front() <= 'Z';
  const bool ended = problem.message.ends_with('.');
  return problem.message + (!sentence ? "; " : ended ? " " : ". ") + problem.hint;
}

}  // namespace axisgate::server
