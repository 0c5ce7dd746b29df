// Time limits and intervals of the server, all of them: tests/tidy finds a duration that stands elsewhere. The limits
// of a controller are in its own folder, and the budgets of connections in server/front/limits.h.
#pragma once

#include <chrono>

#include "device/core/time.h"

namespace axisgate::server {

// --- Requests ---

// Time within which a motion must start, if its caller sets none.
inline constexpr Duration kMotionStartLimit = std::chrono::seconds(5);
// Time limit of any other request, if its caller sets none; also of Execute.
inline constexpr Duration kRequestLimit = std::chrono::seconds(20);
// Longest wait of a WaitMotion.
inline constexpr Duration kMotionWaitMax = std::chrono::hours(1);
// Longest time limit of an Execute.
inline constexpr Duration kExecuteLimitMax = std::chrono::minutes(10);
// Extra time for the controller to report a more exact problem than a timeout.
inline constexpr Duration kExecuteGrace = std::chrono::milliseconds(100);
// Time limit for the answers to questions about settings. A setting that cannot be read while an axis moves keeps its
// last known value.
inline constexpr Duration kSettingAnswerLimit = std::chrono::seconds(2);
// Longest duration of a request's field; longer ones are cut to it.
inline constexpr Duration kSpanMax = std::chrono::hours(24);
// Time after the last piece of a job for which its pieces are kept.
inline constexpr Duration kJobPiecesKept = std::chrono::minutes(10);
// Shortest interval of a watched device's states.
inline constexpr Duration kWatchIntervalMin = std::chrono::milliseconds(10);

// --- Leases ---

// Time for which a lease lives without renewal, if its holder sets none.
inline constexpr Duration kLeaseTimeToLive = std::chrono::seconds(10);
// Shortest and longest time to live. A lease that must be renewed more often would be lost by chance.
inline constexpr Duration kLeaseTimeToLiveMin = std::chrono::seconds(1);
inline constexpr Duration kLeaseTimeToLiveMax = std::chrono::hours(24);
// Longest wait for a lease.
inline constexpr Duration kLeaseWaitMax = std::chrono::hours(24);
// Longest use that a caller may announce.
inline constexpr Duration kLeaseExpectedUseMax = std::chrono::hours(24 * 365);
// Longest pause between two motions of a caller's loop: until then the axes count as in use.
inline constexpr Duration kMovedLately = std::chrono::seconds(10);

// --- Tokens ---

// Validity of a token, if the administrator sets none.
inline constexpr auto kTokenLife = std::chrono::days(90);
// Longest validity of a token.
inline constexpr auto kTokenLifeMax = std::chrono::years(10);
// Time after its end for which a token is still listed.
inline constexpr auto kTokenForgottenAfter = std::chrono::days(30);
// Pause between attempts to write the tokens to the disk.
inline constexpr Duration kTokenRetryPause = std::chrono::seconds(2);

// --- The journal ---

// Duration after which an unfinished commit counts as hanging: commit() then refuses until the commit has returned.
inline constexpr Duration kCommitHangs = std::chrono::seconds(2);
// Time that facts wait for an entry, so that a path's many facts do not sync the disk one by one.
inline constexpr Duration kFactsWait = std::chrono::milliseconds(100);
// Pause between attempts after the journal could not be written.
inline constexpr Duration kJournalRetry = std::chrono::seconds(1);
// Pause between two deletions of old entries.
inline constexpr Duration kJournalDropPause = std::chrono::minutes(10);
// Longest time that a reader waits for a disk that hangs.
inline constexpr Duration kJournalCatchUp = std::chrono::seconds(1);
// Longest time that erasing waits, so that the daemon can end.
inline constexpr Duration kJournalErasing = std::chrono::seconds(10);
// Limit for waiting on a lock of the database; a reader blocks the writer only for moments.
inline constexpr std::chrono::milliseconds kDatabaseLockWait(2000);
// Period in which the refusals of one identity that have entries are counted.
inline constexpr Duration kRefusalPeriod = std::chrono::minutes(10);

// --- Devices ---

// An abort has a few dozen bytes. If the line accepts none of them within this time, it is closed.
inline constexpr Duration kAbortLimit = std::chrono::seconds(3);
// Time that a running job has to finish at the end of the daemon, if `at_exit` says so.
inline constexpr Duration kJobFinishLimit = std::chrono::seconds(60);
// Interval at which a running job is published.
inline constexpr Duration kJobPublishPause = std::chrono::milliseconds(500);
// Longest pause between two stops of one series.
inline constexpr Duration kStopSeriesPause = std::chrono::seconds(10);
// Interval at which a continuing series is reported.
inline constexpr Duration kStopSeriesReport = std::chrono::minutes(10);
// Pause between two log lines about unexpected lines of one device.
inline constexpr Duration kUnexpectedLinePause = std::chrono::seconds(1);
// Pause before a recording that could not be written is tried again.
inline constexpr Duration kRecordingRetryPause = std::chrono::seconds(5);

// --- Connections ---

// Pause of a listener that could not accept, and interval of the search for ended connections of the reserve. Short,
// since a stop may wait until many connections have displaced each other.
inline constexpr Duration kAcceptAgain = std::chrono::milliseconds(5);
// Pause between two log lines of one kind.
inline constexpr Duration kSeldomPause = std::chrono::seconds(10);
// Period in which the log's lines about the refusals of one source are counted.
inline constexpr Duration kRefusalLogWindow = std::chrono::seconds(10);
// Time before the end of a certificate from which it is reported. The alert AxisgateCertificateExpires has the same.
inline constexpr auto kCertificateEndsSoon = std::chrono::days(14);
// Interval at which the certificate is looked at.
inline constexpr auto kCertificateLook = std::chrono::days(1);
// Time after the end of a certificate at which it is looked at. It covers a small difference between the clocks.
inline constexpr Duration kCertificateMargin = std::chrono::seconds(1);
// Interval at which the front looks for connections whose time has run out.
inline constexpr Duration kConnectionsCheck = std::chrono::milliseconds(250);
// Longest delay after refusals: it slows down a client that retries after each refusal. A longer debt counts as a
// flood.
inline constexpr Duration kRefusalsWaitMax = std::chrono::seconds(2);
// Time that a client has to take the last bytes before its connection is closed.
inline constexpr Duration kFarewell = std::chrono::seconds(1);
// Interval at which the certificate's files are looked at when a client connects.
inline constexpr Duration kCertificateFileLook = std::chrono::seconds(1);
// Pause that a refused client is asked to make.
inline constexpr Duration kRetryAfter = std::chrono::seconds(1);

// --- Streams and the end ---

// Time after a half-close in which the break-off of a call may still arrive.
inline constexpr Duration kBreakOffWait = std::chrono::milliseconds(10);
// Interval at which gRPC's queue is woken. Short enough that even a late wake-up comes within the second. Each wake-up
// costs an idle daemon 0.1 % of a CPU.
inline constexpr Duration kQueueWakeUp = std::chrono::milliseconds(700);
// Interval at which unused memory is given back.
inline constexpr Duration kSpareMemoryPause = std::chrono::seconds(20);
// Time that gRPC has to end its calls.
inline constexpr Duration kGrpcShutdown = std::chrono::milliseconds(500);
// Time that the front has to end. A client that does not read must not delay the end for longer.
inline constexpr Duration kFrontEnd = std::chrono::milliseconds(500);
// Time limit of the last exchange on a line. Longer than any reply's time limit and a barrier after it.
inline constexpr Duration kLastExchangeLimit = std::chrono::seconds(10);
// Time for streams and threads to end, after the devices.
inline constexpr Duration kRestOfTheEnd = std::chrono::seconds(5);

}  // namespace axisgate::server
