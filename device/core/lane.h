// Lanes in which commands wait for the one line, in the order of their priority.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace axisgate {

enum class Lane { stop, path_refill, motion, question, poll };

inline constexpr std::size_t kLaneCount = 5;
inline constexpr std::array<std::string_view, kLaneCount> kLaneNames = {"stop", "path_refill", "motion", "question",
                                                                        "poll"};

inline std::string_view name(Lane lane) { return kLaneNames[static_cast<std::size_t>(lane)]; }

}  // namespace axisgate
