// What a job may be called.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate::server::spool {

inline constexpr std::size_t kNameMax = 100;  // bytes

// The last part of what may be a path of any system ("C:\jobs\part.rml" is "part.rml"), without blanks around it. For
// people to read: no path is ever made of it. invalid_request, where that is empty, longer than kNameMax, no UTF-8,
// begins with a dot, or has characters that would change how the text around it is shown.
Result<std::string> job_name(std::string_view text);

}  // namespace axisgate::server::spool
