// The only error type: what happened, where, why, and what to do about it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace axisgate {

// Reasons are stable: clients match on these names. Their order and meaning never change; new ones are appended.
enum class Reason {
  unspecified,
  // the request itself
  invalid_request,
  unknown_device,
  unknown_axis,
  unknown_unit,
  out_of_range,
  outside_travel,
  too_fast,
  not_representable,
  malformed_line,
  unknown_command,
  incomplete_transaction,
  not_found,
  // the state of the device
  axis_busy,
  not_excited,
  limit_detected,
  emergency_stopped,
  device_error,
  wrong_mode,
  stale_setpoint,
  position_unknown,
  device_refused,
  identity_mismatch,
  // the line
  link_down,
  not_sent,
  reply_timed_out,
  line_fault,
  completion_outstanding,
  // the gateway
  deadline_passed,
  queue_full,
  stopped,
  target_not_reached,
  outcome_unknown,
  compacted,
  internal,
  // rights and conditions of the caller
  lease_held,
  lease_lost,
  outside_lease,
  stopped_by,
  not_allowed,
  unauthenticated,
  epoch_passed,
  not_homed,
  unexplained,
  // the journal
  journal_unavailable,
  request_id_reused,
  request_memory_lost,
  // stops
  stop_unconfirmed,
  // the daemon
  daemon_ending,
  // jobs
  wrong_job_state,
  setup_changed,
  not_confirmed,
};
inline constexpr Reason kLastReason = Reason::not_confirmed;

// Returns a name such as "STALE_SETPOINT", as in the API and in log lines.
std::string_view name(Reason reason);

struct Problem {
  Reason reason = Reason::unspecified;
  std::string message{};      // one sentence for a person: what, where, why
  std::string hint{};         // remedy; may be empty
  std::optional<int> axis{};  // axis number, from 1; nullopt if no single axis is concerned
  std::string sent{};         // the line concerned, without terminator; may be empty
  std::string wire_reply{};   // the device's answer, unescaped; may be empty
};

template <class T>
using Result = tl::expected<T, Problem>;

inline tl::unexpected<Problem> fail(Reason reason, std::string message, std::string hint = {}) {
  return tl::unexpected<Problem>(Problem{.reason = reason, .message = std::move(message), .hint = std::move(hint)});
}

}  // namespace axisgate
