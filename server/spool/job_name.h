// Names of jobs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate::server::spool {

inline constexpr std::size_t kNameMax = 100;  // bytes

// Returns the last part of a path of any system ("C:\jobs\part.rml" becomes "part.rml"), without blanks around it. The
// name is for people: no path is ever made of it. Fails with invalid_request if it is empty, longer than kNameMax, not
// UTF-8, begins with a dot, or has characters that would change how the text around it is shown.
Result<std::string> job_name(std::string_view text);

}  // namespace axisgate::server::spool
