// A problem as one line for people.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate {

// Returns the message and the hint as one sentence, or as two if the hint begins with a capital.
inline std::string explain(const Problem& problem) {
  if (problem.hint.empty()) return problem.message;
  const bool sentence = problem.hint.front() >= 'A' && problem.hint.front() <= 'Z';
  const bool ended = problem.message.ends_with('.');
  return problem.message + (!sentence ? "; " : ended ? " " : ". ") + problem.hint;
}

}  // namespace axisgate
