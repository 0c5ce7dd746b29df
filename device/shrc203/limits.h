// Time limits and numbers of attempts for one controller, beyond those of its line (device/shot/limits.h). The
// configuration changes none of these; the limits that it changes are in the Profile: reply_limit, idle_poll,
// moving_poll. Limits that clients must know, too, are in device/stage/stage_controller.h: kJogSilence, kFinishLimit,
// kStopLimit.
#pragma once

#include "device/core/time.h"
#include "device/shot/limits.h"

namespace axisgate::shrc203 {

// --- Questions and settings ---

// Time limit for writing a caller's lines, and the lines that clear errors, if the caller sets none. A question whose
// reply is a bare number may have to wait for motions to end.
inline constexpr Duration kCallerWriteLimit = std::chrono::seconds(20);
// Time limit for writing the gateway's own lines, and those inside a motion or a transaction: they outlast a barrier.
inline constexpr Duration kStepWriteLimit = std::chrono::seconds(30);
// Time limit for writing ?:SLEEP, which only explains a refusal: its reply is a bare number, and nobody waits long for
// it.
inline constexpr Duration kSleepQuestionLimit = std::chrono::seconds(1);

// Waiting time after which a question has its turn while motions follow one another, and a motion of several axes while
// others use them in turn.
inline constexpr Duration kTurnAfter = std::chrono::seconds(2);
// Longest time that a question keeps motions out: less than kMotionStartLimit, so that no motion is refused because of
// a question.
inline constexpr Duration kTurnLimit = std::chrono::seconds(4);

// Maximum number of reads for values that must be read twice with the same result.
inline constexpr int kAgreeingAnswerTries = 4;
// Maximum number of immediate readings that confirm a change at the stage; two must agree.
inline constexpr int kReadingsOfAChange = 2;
// Maximum number of attempts of a question whose reply may be a completion; two replies must agree.
inline constexpr int kClosedQuestionTries = 8;
// Maximum number of reads of a setting that is unknown or was misread.
inline constexpr int kSettingReadTries = 3;

// --- Motions ---

// Time limit for writing the lines that begin a motion, if the caller sets none.
inline constexpr Duration kMotionStartLimit = std::chrono::seconds(5);
// Number of attempts to write a setpoint. A setpoint starts nothing, so it is read back if its reply was lost, and sent
// again if it did not arrive.
inline constexpr int kSetpointTries = 3;
// Time after which a start that arrived is visible, and READY away from the target is accepted. Status and positions
// may be outdated for 0.1 s after a start.
inline constexpr Duration kStartVisibleWithin = std::chrono::milliseconds(300);
// Pause between two readings of READY, which must agree. While a motion is watched, the configuration's moving_poll
// applies if it is shorter.
inline constexpr Duration kReadyPoll = std::chrono::milliseconds(60);
// Longest pause between readings of a move whose state nobody follows, for events without a completion: a stop at the
// front panel, a motor that was switched off. The configuration's idle_poll applies if it is shorter.
inline constexpr Duration kUnfollowedPoll = std::chrono::seconds(1);
// First pause before a busy controller is asked again after all completions have arrived. Each further pause is twice
// as long, at most kReadyPoll: settling takes some milliseconds (manual 56) W:).
inline constexpr Duration kReadyPauseMin = std::chrono::milliseconds(5);
// Precision of the measured delay from the completions to READY.
inline constexpr Duration kReadyLagPrecision = std::chrono::milliseconds(2);
// Longest delay from the completions to READY that counts as settling.
inline constexpr Duration kReadyLagMax = std::chrono::milliseconds(200);
// Number of failed readings in a row that a motion may have; after one more its outcome is unknown, or the jog is
// stopped.
inline constexpr int kMotionReadFailuresMax = 20;
// Number of attempts of a pending restore: speeds, outputs, trigger.
inline constexpr int kRestoreTries = 3;
// Time limit and pause between attempts for restoring the trigger after a scan: T: is refused while anything moves
// (manual 97) to 101)).
inline constexpr Duration kTriggerRestoreLimit = std::chrono::seconds(10);
inline constexpr Duration kTriggerRestorePause = std::chrono::milliseconds(60);

// --- Stop ---

// Time after which a caller is notified that the line does not work and the stop stays open.
inline constexpr Duration kStopReopenLimit = std::chrono::seconds(1);
// Time limit for writing a stop on an open line: only other stops and a barrier are before it.
inline constexpr Duration kStopWriteLimit = std::chrono::seconds(10);
// Time for the axes to become stationary, after which a caller is notified that the stop stays open. The longest R is 1
// s (manual 89) D:).
inline constexpr Duration kStopStationaryLimit = std::chrono::seconds(10);
// Time after the expected deceleration at which an axis that still moves is stopped again.
inline constexpr Duration kStopRepeatAfterSlowing = std::chrono::milliseconds(200);
// Longest time that questions after the axes are stationary (prebuffers, excitation) may delay the answer to a stop;
// twice that while a motion occupies the axes.
inline constexpr Duration kStopAnswerLimit = std::chrono::milliseconds(500);
// Pause between two readings of axes that should soon be stationary, and of axes that only a person can help.
inline constexpr Duration kStopStationaryPoll = std::chrono::milliseconds(50);
inline constexpr Duration kStopLastingPoll = std::chrono::seconds(5);

// --- Jog ---

// Time limit for writing a change of speed. Changes come often, and a late one is outdated.
inline constexpr Duration kJogSpeedWriteLimit = std::chrono::seconds(1);
inline constexpr int kJogSpeedTries = 3;
// Time after a stop at which a jog that still runs is stopped again.
inline constexpr Duration kJogStopRepeat = std::chrono::seconds(1);
// Pause between checks of the jog's lease: no event reports its end.
inline constexpr Duration kJogLeasePoll = std::chrono::milliseconds(50);
// Longest delay of the host when it stops a jog before its travel limit: the host is no real-time system.
inline constexpr Duration kJogHostDelayMax = std::chrono::milliseconds(50);

// --- Path ---

// Time that the host takes to write a refill, part of the shortest feasible segment: the host is no real-time system.
inline constexpr Duration kRefillHostDelay = std::chrono::milliseconds(5);
// Tolerance of segment times, which are computed in floating point.
inline constexpr Duration kSegmentTimePrecision = std::chrono::microseconds(1);
// Time by which a segment's completion may come before its shortest duration. Earlier completions are checked.
inline constexpr Duration kCompletionEarlyMax = std::chrono::milliseconds(5);
// Delay after a segment's longest duration from which its completion counts as lost, and the prebuffer is read.
inline constexpr Duration kCompletionLateMax = std::chrono::milliseconds(100);
// Further delay after which a segment counts as never ending.
inline constexpr Duration kSegmentEndLimit = std::chrono::seconds(10);
// Delay after a segment's longest duration from which READY away from its end is accepted.
inline constexpr Duration kSegmentEndVisibleWithin = std::chrono::milliseconds(500);
// Pause between two readings of the inputs that a segment waits for (manual 95) I:).
inline constexpr Duration kInputsPoll = std::chrono::milliseconds(20);
// Number of attempts of T:, which moves nothing and may be repeated, so it is written again if it was not answered.
inline constexpr int kTriggerTries = 3;

// --- Session: the handshake, other modes, leases ---

// Number of attempts of a handshake step without a readable reply.
inline constexpr int kHandshakeTries = 3;
// Pause between readings of the mode. Somebody may change it at the front panel at any time (manual 37) ?:MODE); people
// do not notice a second.
inline constexpr Duration kHandshakeModePoll = std::chrono::seconds(1);
// Pause between readings until everything is stationary.
inline constexpr Duration kHandshakeReadyPoll = std::chrono::milliseconds(100);

// Pause between two readings of a program's status (manual 41) ?:L), and between steps back to HOST.
inline constexpr Duration kProgramPoll = std::chrono::milliseconds(100);
// Number of unreadable replies to ?:L in a row after which the program's outcome is unknown.
inline constexpr int kProgramReadTries = 5;
// Time limit for a program's axes to become stationary, and then for the steps back to HOST.
inline constexpr Duration kReturnToHostLimit = std::chrono::seconds(15);
// Time over which notices of a program, P:C and P:T, are combined into one event: hundreds can arrive (manual 109),
// 110)).
inline constexpr Duration kProgramNoticePause = std::chrono::milliseconds(100);

// Time limit for restoring a lease's settings, counted from the reconnection of the line; and the pause between
// attempts.
inline constexpr Duration kLeaseRestoreLimit = std::chrono::seconds(10);
inline constexpr Duration kLeaseRestorePause = std::chrono::milliseconds(100);

// --- The gateway's end ---

// Time limit for writing each restored setting at the end.
inline constexpr Duration kEndRestoreWriteLimit = std::chrono::seconds(1);
// Pause between two checks of motions and exchanges that are not finished.
inline constexpr Duration kEndPoll = std::chrono::milliseconds(5);
// Time for the driver to send a last stop, in addition to the time of its bytes: closing a line drops unsent bytes.
inline constexpr Duration kEndTransmitTime = std::chrono::milliseconds(50);

// --- The replay of a recording ---

// Longest delay with which a busy machine notices a time limit. The replay lets this time pass before it acts on a
// limit without a recorded event; otherwise it would overtake the recording.
inline constexpr Duration kReplayLateMax = std::chrono::milliseconds(100);
// Error of recorded times, which are truncated to microseconds: due times may seem to be a little later.
inline constexpr Duration kRecordedTimeError = std::chrono::microseconds(2);
// Time limit for writing a request in a replay, which waits as long as the recording says.
inline constexpr Duration kReplayWriteLimit = std::chrono::hours(1);
// Step of the connect that the replay invents if a recording begins with the line up. It is longer than any silence
// that the connect needs.
inline constexpr Duration kReplayConnectStep = std::chrono::seconds(1);

}  // namespace axisgate::shrc203
