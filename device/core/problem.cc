#include "device/core/problem.h"

#include <array>
#include <cstddef>

namespace axisgate {
namespace {

// In the order of Reason.
constexpr auto kNames = std::to_array<std::string_view>({
    "UNSPECIFIED",
    "INVALID_REQUEST",
    "UNKNOWN_DEVICE",
    "UNKNOWN_AXIS",
    "UNKNOWN_UNIT",
    "OUT_OF_RANGE",
    "OUTSIDE_TRAVEL",
    "TOO_FAST",
    "NOT_REPRESENTABLE",
    "MALFORMED_LINE",
    "UNKNOWN_COMMAND",
    "INCOMPLETE_TRANSACTION",
    "NOT_FOUND",
    "AXIS_BUSY",
    "NOT_EXCITED",
    "LIMIT_DETECTED",
    "EMERGENCY_STOPPED",
    "DEVICE_ERROR",
    "WRONG_MODE",
    "STALE_SETPOINT",
    "POSITION_UNKNOWN",
    "DEVICE_REFUSED",
    "IDENTITY_MISMATCH",
    "LINK_DOWN",
    "NOT_SENT",
    "REPLY_TIMED_OUT",
    "LINE_FAULT",
    "COMPLETION_OUTSTANDING",
    "DEADLINE_PASSED",
    "QUEUE_FULL",
    "STOPPED",
    "TARGET_NOT_REACHED",
    "OUTCOME_UNKNOWN",
    "COMPACTED",
    "INTERNAL",
    "LEASE_HELD",
    "LEASE_LOST",
    "OUTSIDE_LEASE",
    "STOPPED_BY",
    "NOT_ALLOWED",
    "UNAUTHENTICATED",
    "EPOCH_PASSED",
    "NOT_HOMED",
    "UNEXPLAINED",
    "JOURNAL_UNAVAILABLE",
    "REQUEST_ID_REUSED",
    "REQUEST_MEMORY_LOST",
    "STOP_UNCONFIRMED",
    "DAEMON_ENDING",
    "WRONG_JOB_STATE",
    "SETUP_CHANGED",
    "NOT_CONFIRMED",
});
static_assert(kNames.size() == static_cast<std::size_t>(kLastReason) + 1, "a name for each Reason");

}  // namespace

std::string_view name(Reason reason) { return kNames.at(static_cast<std::size_t>(reason)); }

}  // namespace axisgate
