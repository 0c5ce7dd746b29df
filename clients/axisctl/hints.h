// Hints of the daemon in the words of axisctl. The daemon's hints name calls of the API, such as `ClearErrors`, because
// they are read by callers in every language.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::axisctl {

// Returns the hint with each call of the API, in backquotes, replaced by the command of axisctl: "`axisctl clear`". A
// call without a command stays as it is. `axis` is the number of the axis concerned, or 0.
std::string with_commands(std::string_view hint, int axis);

}  // namespace axisgate::axisctl
