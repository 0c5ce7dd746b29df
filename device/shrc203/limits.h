// How long the gateway waits for one controller, and how often it tries. The configuration changes none of these; what
// it changes is in the Profile: reply_limit, idle_poll, moving_poll. What clients must know, too, is in
// device/stage/stage_controller.h: kJogSilence, kFinishLimit, kStopLimit.
#pragma once

#include "device/core/time.h"

namespace axisgate::shrc203 {

// --- The line ---

// A line that was lost is opened again after a pause that doubles each time: an unplugged adapter costs little, and
// one that is back is found within seconds.
inline constexpr Duration kReopenBackoffMin = std::chrono::milliseconds(250);
inline constexpr Duration kReopenBackoffMax = std::chrono::seconds(5);

// The reply limit of commands that write to the controller's memory, which takes longer than other replies. For all
// others it is the configuration's reply_limit.
inline constexpr Duration kSavingReplyLimit = std::chrono::seconds(5);

// How long half a line may hold up the next command. Its bytes follow each other at once, so one that has not ended by
// then never does.
inline constexpr Duration kPartialLineLimit = std::chrono::milliseconds(50);

// A stop that the line has cut in two is refused twice: the second NG must not meet the next stop.
inline constexpr Duration kPauseAfterRefusedStop = std::chrono::milliseconds(20);

// The barrier ends with silence, for this long or longer: a slow controller may still have other answers to give.
inline constexpr Duration kBarrierSilenceMin = std::chrono::milliseconds(50);
// A line that is never silent is as good as none.
inline constexpr Duration kBarrierSilenceLimit = std::chrono::seconds(5);
// So many probes without an answer, and the line is opened again.
inline constexpr int kBarrierProbesMax = 3;

// No controller restarts in so short a time, the answer's and the line's way included. One may have after an answer
// that came later than that (manual 46) RESET:).
inline constexpr Duration kRestartMin = std::chrono::milliseconds(150);

// How long after READY was seen a completion may still arrive.
inline constexpr Duration kCompletionAfterReadyMax = std::chrono::milliseconds(200);
// None can arrive any more: 10 ms past that moment.
inline constexpr Duration kNoCompletionAfterReady = std::chrono::milliseconds(210);
// How soon after a start READY may still describe the time before it: the manual does not say.
inline constexpr Duration kReadyOutdatedMax = std::chrono::milliseconds(150);

// What an exchange takes beyond its bytes, until the first one has been measured.
inline constexpr Duration kTurnaroundAssumed = std::chrono::milliseconds(5);

// --- Questions and settings ---

// A caller's lines, and what clears errors, are written within this time, when the caller sets no limit. A question
// whose answer is a bare number may have to wait for motions to end.
inline constexpr Duration kCallerWriteLimit = std::chrono::seconds(20);
// The gateway's own lines, and those inside a motion or a transaction: they outlast a barrier.
inline constexpr Duration kStepWriteLimit = std::chrono::seconds(30);
// ?:SLEEP only explains a refusal, and its answer is a bare number: nobody waits long for that.
inline constexpr Duration kSleepQuestionLimit = std::chrono::seconds(1);

// What has waited so long has its turn: a question while motions follow one another, a motion of several axes while
// others use them in turn.
inline constexpr Duration kTurnAfter = std::chrono::seconds(2);
// A question keeps motions out no longer than this: less than kMotionStartLimit, so that none is refused for its sake.
inline constexpr Duration kTurnLimit = std::chrono::seconds(4);

// What must not be misread is asked until two answers in a row agree, so often at most.
inline constexpr int kAgreeingAnswerTries = 4;
// A change at the stage is read again at once: two readings must agree.
inline constexpr int kReadingsOfAChange = 2;
// A question whose answer may be a completion is asked until two answers agree, so often at most.
inline constexpr int kClosedQuestionTries = 8;
// A setting that is not known yet, or was misread, is read so often at most.
inline constexpr int kSettingReadTries = 3;

// --- Motions ---

// Lines that begin a motion are written within this time, when the caller sets no limit.
inline constexpr Duration kMotionStartLimit = std::chrono::seconds(5);
// A setpoint starts nothing: where its answer was lost it is read back, and sent again if it did not arrive.
inline constexpr int kSetpointTries = 3;
// Status and positions may still be the old ones for 0.1 s after a start. By then a start that arrived can be seen, and
// READY elsewhere than at the target is believed.
inline constexpr Duration kStartVisibleWithin = std::chrono::milliseconds(300);
// Between two readings of READY, which must agree. The configuration's moving_poll, where that is shorter and a motion
// is watched.
inline constexpr Duration kReadyPoll = std::chrono::milliseconds(60);
// A move whose state nobody follows is looked at so often before its time, for what no axis number reports: a stop at
// the front panel, a motor that was switched off. Or after the configuration's idle_poll, where that is shorter.
inline constexpr Duration kUnfollowedPoll = std::chrono::seconds(1);
// Where all axis numbers have come and the controller is still busy, it is asked again so soon. Then after twice as
// long each time, at most kReadyPoll: settling takes some milliseconds (manual 56) W:).
inline constexpr Duration kReadyPauseMin = std::chrono::milliseconds(5);
// The first question after the axis numbers comes no later than it must, to within this.
inline constexpr Duration kReadyLagPrecision = std::chrono::milliseconds(2);
// A READY that comes later than this after the axis numbers has another cause than settling.
inline constexpr Duration kReadyLagMax = std::chrono::milliseconds(200);
// A gateway that cannot read the positions for this many times has lost the motion.
inline constexpr int kMotionReadFailuresMax = 20;
// A pending restore is attempted so often: speeds, outputs, trigger.
inline constexpr int kRestoreTries = 3;
// After a scan the trigger is restored, and T: is refused while anything moves (manual 97) to 101)).
inline constexpr Duration kTriggerRestoreLimit = std::chrono::seconds(10);
inline constexpr Duration kTriggerRestorePause = std::chrono::milliseconds(60);

// --- Stop ---

// A caller is notified after this time that the line does not work, and that the stop stays open.
inline constexpr Duration kStopReopenLimit = std::chrono::seconds(1);
// How long a stop waits for its turn on a line that is open: only other stops and a barrier are before it.
inline constexpr Duration kStopWriteLimit = std::chrono::seconds(10);
// How long the axes may take to be stationary before a caller is notified that the stop stays open. The longest R is 1
// s (manual 89) D:).
inline constexpr Duration kStopStationaryLimit = std::chrono::seconds(10);
// An axis that still moves so long after it should have slowed down is stopped again.
inline constexpr Duration kStopRepeatAfterSlowing = std::chrono::milliseconds(200);
// What is asked once the axes are stationary (prebuffers, excitation) holds up the answer to a stop no longer than
// this.
inline constexpr Duration kStopAnswerLimit = std::chrono::milliseconds(500);  // twice while a motion has no outcome
// Between two looks at axes that are to be stationary soon, and at those that only a person can help.
inline constexpr Duration kStopStationaryPoll = std::chrono::milliseconds(50);
inline constexpr Duration kStopLastingPoll = std::chrono::seconds(5);

// --- Jog ---

// Changes of speed come often, and a late one is outdated.
inline constexpr Duration kJogSpeedWriteLimit = std::chrono::seconds(1);
inline constexpr int kJogSpeedTries = 3;
// A jog that still runs so long after its stop is stopped again.
inline constexpr Duration kJogStopRepeat = std::chrono::seconds(1);
// A lease ends without an event: the jog looks.
inline constexpr Duration kJogLeasePoll = std::chrono::milliseconds(50);
// How late the host may stop a jog before its travel limit: it is no real-time system.
inline constexpr Duration kJogHostDelayMax = std::chrono::milliseconds(50);

// --- Path ---

// What the host takes to write a refill, as the shortest feasible segment counts it: it is no real-time system.
inline constexpr Duration kRefillHostDelay = std::chrono::milliseconds(5);
// Times of segments are computed in floating point.
inline constexpr Duration kSegmentTimePrecision = std::chrono::microseconds(1);
// How long after a refill is due the line is kept free for it: settling (manual 56) W:) and the completion's bytes. A
// segment that has not ended by then is late, and holds nobody up any longer.
inline constexpr Duration kRefillReservedAfterDue = std::chrono::milliseconds(50);
// A segment's completion may come so much before its shortest time. One that is earlier is checked.
inline constexpr Duration kCompletionEarlyMax = std::chrono::milliseconds(5);
// So long after a segment's longest time its completion is taken for lost, and the prebuffer is read.
inline constexpr Duration kCompletionLateMax = std::chrono::milliseconds(100);
// A segment that has not ended so long after that never will.
inline constexpr Duration kSegmentEndLimit = std::chrono::seconds(10);
// READY elsewhere than at a segment's end is believed so long after the segment's longest time.
inline constexpr Duration kSegmentEndVisibleWithin = std::chrono::milliseconds(500);
// Between two readings of the inputs that a segment waits for (manual 95) I:).
inline constexpr Duration kInputsPoll = std::chrono::milliseconds(20);
// T: moves nothing, and the same twice is the same, so one that was not answered is written again.
inline constexpr int kTriggerTries = 3;

// --- Session: the handshake, other modes, leases ---

// A step of the handshake without a readable answer is repeated, so often at most.
inline constexpr int kHandshakeTries = 3;
// Somebody may change the mode at the front panel at any time (manual 37) ?:MODE); people do not notice a second.
inline constexpr Duration kHandshakeModePoll = std::chrono::seconds(1);
// Until everything is stationary.
inline constexpr Duration kHandshakeReadyPoll = std::chrono::milliseconds(100);

// Between two readings of how far a program is (manual 41) ?:L), and between steps back to HOST.
inline constexpr Duration kProgramPoll = std::chrono::milliseconds(100);
// So many unreadable answers to ?:L in a row, and the program's end is unknown.
inline constexpr int kProgramReadTries = 5;
// How long a program's axes may take to be stationary, and then the steps back to HOST.
inline constexpr Duration kReturnToHostLimit = std::chrono::seconds(15);
// Notices of a program, P:C and P:T, can come by the hundred (manual 109), 110)): those of this time make one event.
inline constexpr Duration kProgramNoticePause = std::chrono::milliseconds(100);

// When a lease ends, its settings are restored within this time from the line's coming back.
inline constexpr Duration kLeaseRestoreLimit = std::chrono::seconds(10);
inline constexpr Duration kLeaseRestorePause = std::chrono::milliseconds(100);

// --- The gateway's end ---

// Restoring one setting must not hold up the end for longer.
inline constexpr Duration kEndRestoreWriteLimit = std::chrono::seconds(1);
// Between two looks at what still runs.
inline constexpr Duration kEndPoll = std::chrono::milliseconds(5);
// Closing a line drops what its driver has not sent yet: a last stop has this time, and that of its bytes.
inline constexpr Duration kEndTransmitTime = std::chrono::milliseconds(50);

// --- The replay of a recording ---

// On a busy machine a time limit is seen to pass so much too late. Until then nothing is made of it that was not
// recorded, or the replay would overtake the recording.
inline constexpr Duration kReplayLateMax = std::chrono::milliseconds(100);
// Recorded times are cut off to microseconds, so that what was due may seem to be due a little later.
inline constexpr Duration kRecordedTimeError = std::chrono::microseconds(2);
// A request in a replay waits as long as the recording says, so it has no limit of its own.
inline constexpr Duration kReplayWriteLimit = std::chrono::hours(1);
// A recording may begin with the line up. Its connect is invented, in steps that are longer than any silence it needs.
inline constexpr Duration kReplayConnectStep = std::chrono::seconds(1);

}  // namespace axisgate::shrc203
