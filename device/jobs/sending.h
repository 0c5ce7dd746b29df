// State and progress of sending a job.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace axisgate::jobs {

enum class SenderState { ready, sending, paused, finishing, fed, aborting, aborted, lost, raising, raised };
std::string_view name(SenderState state);  // "READY", "SENDING" ...
bool is_end(SenderState state);
inline constexpr std::size_t kSenderStates = static_cast<std::size_t>(SenderState::raised) + 1;

// Progress of sending a job, in bytes of the job.
struct SendProgress {
  std::uint64_t written = 0;         // written to the line
  std::uint64_t unsent = 0;          // written, but still in the host, as far as its driver knows
  std::uint64_t taken = 0;           // taken by the mill, at least; never decreases
  std::uint64_t executed_least = 0;  // executed by the slowest mill
  std::uint64_t executed_most = 0;   // executed by the fastest mill
};

}  // namespace axisgate::jobs
