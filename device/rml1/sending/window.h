// Choice of the window: how many bytes may be sent beyond those that the mill has executed.
#pragma once

#include <cstddef>
#include <string_view>

#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// Possible windows, in bytes. The first is large enough if the mill needs more time for each command than the line. The
// last is half of the default SendSettings::buffer.
inline constexpr std::size_t kWindows[] = {64, 128, 256, 512};

// Returns the smallest of kWindows with which the job takes at most 1 % longer than with the largest, on a mill that
// needs `slower` times as long as the slowest mill of its profile.
std::size_t adapted_window(std::string_view job, const Timeline& timeline, double slower, int baud);

}  // namespace axisgate::rml1
