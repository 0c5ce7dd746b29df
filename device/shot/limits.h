// Time limits and numbers of attempts of the line to one controller. The configuration changes none of these; the limit
// that it changes is the Profile's reply_limit.
#pragma once

#include "device/core/time.h"

namespace axisgate::shot {

// Pause before a lost line is opened again. It doubles each time: an unplugged adapter costs little, and a returning
// one is found within seconds.
inline constexpr Duration kReopenBackoffMin = std::chrono::milliseconds(250);
inline constexpr Duration kReopenBackoffMax = std::chrono::seconds(5);

// Reply limit of commands that write to the controller's memory, which takes longer than other replies. All other
// commands have the configuration's reply_limit.
inline constexpr Duration kSavingReplyLimit = std::chrono::seconds(5);

// Longest time an incomplete line may delay the next command. A line's bytes arrive without gaps, so an incomplete line
// after this time stays incomplete.
inline constexpr Duration kPartialLineLimit = std::chrono::milliseconds(50);

// Pause after a refused stop. A stop that the line has cut in two is refused twice, and the second NG must not be taken
// for the reply to the next stop.
inline constexpr Duration kPauseAfterRefusedStop = std::chrono::milliseconds(20);

// Shortest silence at the end of a barrier: a slow controller may still send other replies.
inline constexpr Duration kBarrierSilenceMin = std::chrono::milliseconds(50);
// Longest wait for that silence. A line that is never silent cannot be used.
inline constexpr Duration kBarrierSilenceLimit = std::chrono::seconds(5);
// Number of probes without a reply after which the line is opened again.
inline constexpr int kBarrierProbesMax = 3;

// Shortest duration of a restart, including the time of the reply on the line. A controller may have restarted if its
// reply came later than that (manual 46) RESET:).
inline constexpr Duration kRestartMin = std::chrono::milliseconds(150);

// Time after READY in which a completion may still arrive.
inline constexpr Duration kCompletionAfterReadyMax = std::chrono::milliseconds(200);
// Time after READY from which no completion can arrive: 10 ms later.
inline constexpr Duration kNoCompletionAfterReady = std::chrono::milliseconds(210);
// Time after a start in which READY may still describe the state before it; the manual does not give it.
inline constexpr Duration kReadyOutdatedMax = std::chrono::milliseconds(150);

// Assumed time of an exchange beyond that of its bytes, until the first exchange has been measured.
inline constexpr Duration kTurnaroundAssumed = std::chrono::milliseconds(5);

// Time for which the line is kept free after a refill is due: settling (manual 56) W:) and the completion's bytes. A
// segment that has not ended by then is late, and delays nobody any longer.
inline constexpr Duration kRefillReservedAfterDue = std::chrono::milliseconds(50);

}  // namespace axisgate::shot
