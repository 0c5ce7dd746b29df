// Guards of mill jobs, like the guards of stages in device/core/guard.h: they keep a job, its abort and its outcome
// correct on a bad line. Each guard is queried at the place where it acts. Tests remove each guard
// (tests/guards/mill_guards_test.cc).
#pragma once

#ifdef AXISGATE_REMOVABLE_GUARDS
#include <optional>
#endif

namespace axisgate::jobs {

enum class MillGuard {
  // Limits on bytes sent before the mill has executed them
  window,
  window_fits_buffer,
  one_command_unsent,
  nothing_while_held,
  counted_from_arrival,

  // Aborts
  abort_ends_job,
  abort_is_not_held,
  abort_after_loss,

  // Outcomes that must not be reported too early
  fed_by_the_slowest,
  fed_when_arrived,
  converter_in_range,

  // Conditions for starting a job
  void_after_abort,
  void_after_loss,
  settled_before_next,
};
inline constexpr int kMillGuards = static_cast<int>(MillGuard::settled_before_next) + 1;

#ifdef AXISGATE_REMOVABLE_GUARDS
inline std::optional<MillGuard> removed_mill_guard;
inline bool guarded(MillGuard guard) { return removed_mill_guard != guard; }
#else
constexpr bool guarded(MillGuard) { return true; }
#endif

}  // namespace axisgate::jobs
