// Chooses how many bytes a mill is given ahead of those that it has executed.
#pragma once

#include <cstddef>
#include <string_view>

#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// The first is enough where each command takes the mill longer than the line. The last is half of the mill's buffer.
inline constexpr std::size_t kWindows[] = {64, 128, 256, 512};  // bytes

// The smallest of these with which a mill that is `slower` times as slow as the slowest of its profile waits for its
// bytes hardly longer than with the largest: the job takes at most a hundredth longer.
std::size_t adapted_window(std::string_view job, const Timeline& timeline, double slower, int baud);

}  // namespace axisgate::rml1
