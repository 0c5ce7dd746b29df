// Sending of a job: its state, and how far it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace axisgate::jobs {

enum class SenderState { ready, sending, paused, finishing, fed, aborting, aborted, lost, raising, raised };
std::string_view name(SenderState state);  // "READY", "SENDING" ...
bool is_end(SenderState state);
inline constexpr std::size_t kSenderStates = static_cast<std::size_t>(SenderState::raised) + 1;

// Bytes of the job.
struct SendProgress {
  std::uint64_t written = 0;         // to the line
  std::uint64_t unsent = 0;          // of these, still in the host, as far as that can be known
  std::uint64_t taken = 0;           // at least, by the mill; never descends
  std::uint64_t executed_least = 0;  // by the slowest mill
  std::uint64_t executed_most = 0;   // by the fastest
};

}  // namespace axisgate::jobs
