// Guards keep answers, outcomes and stops correct on a bad line. Each guard is queried at the place where it acts,
//
//   if (guarded(Guard::x) && ...)
//
// which costs nothing, since the answer is always yes. Only a build with AXISGATE_REMOVABLE_GUARDS can remove a guard,
// so that tests/guards can show that a test fails without it.
#pragma once

#ifdef AXISGATE_REMOVABLE_GUARDS
#include <optional>
#endif

namespace axisgate {

enum class Guard {
  // Matching of answers to commands after doubt
  barrier_after_time_limit,
  barrier_after_garbage,
  barrier_after_line_fault,
  received_or_not,
  silence,
  silence_after_reconnect,
  half_lines_break_silence,
  outstanding_answers,
  outstanding_refusals,
  older_identities,
  three_probes,
  backoff,
  // Matching of answers to commands before doubt
  half_lines_hold,
  half_lines_before_stops,
  unended_lines,
  overlong_lines,
  question_after_refusal,
  refusals_before_stops,
  quiet_after_refused_stop,
  setter_grammar,
  question_grammar,
  shared_questions,
  restart_suspected,
  restart_read_twice,
  late_answers_hide_restarts,
  question_before_pause_ends,
  flooded_line_shut,
  foreign_traffic,
  possible_lines_before,

  // Separation of notices and replies
  number_questions_wait,
  questions_for_all_axes,
  closed_questions,
  two_answers_agree,
  answers_come_alone,
  possible_after_connect,
  possible_after_ready,
  possible_after_chained_setting,
  possible_when_seen_busy,
  start_settles,
  settled_by_exchange,

  // Identity of the controller
  serial_number,
  serial_number_after_barrier,
  serial_number_twice,
  identity_twice,
  axes_twice,
  host_mode,
  ready_before_open,

  // Reports that require proof
  success_when_ready,
  success_at_target,
  success_without_error,
  success_seen_twice,
  home_seen_to_run,
  end_seen_twice,
  start_shows_late,
  refused_start_looked_at,
  not_sent_is_proved,
  set_read_back,
  jumps_read_again,
  possible_speeds,
  moving_unknown,
  foreign_motion_reported,
  conditions_seen_twice,
  one_home_an_axis,

  // Priority of stops
  stop_lane,
  stop_in_barrier,
  barrier_after_stop,
  stop_withdraws_lines,
  stop_withdraws_motions,
  stop_before_preparing,
  stop_before_set,
  stop_before_go,
  stop_names_excited_axes,
  stop_one_axis_at_a_time,
  stop_again,
  stop_confirmed_stationary,
  stop_looks_at_prebuffer,
  stops_hold_motions,
  stops_join,
  stops_by_turns,
  stop_off_host,
  stop_stays_open,
  stop_written_at_open,
  stop_written_when_heard,
  stop_seen_twice,
  stop_not_to_another_unit,
  stop_reopens_soon,
  stop_awaits_outcomes,
  wider_stop_replaces,
  open_stop_refuses_motion,
  unseen_motion_keeps_its_axes,
  emergency_latches,
  emergency_cleared_for_all,

  // Setpoint and start as one step
  one_motion_at_a_time,
  axes_stand_first,
  late_numbers_wait,
  registers_unknown_after_connect,
  registers_unknown_after_failure,
  registers_unknown_after_transaction,
  stale_setpoints_deleted,
  others_setpoints_stay,
  stale_setpoints_refused,
  no_bare_go,
  no_set_without_go,
  prebuffers_are_one_motions,
  path_owns_prebuffers,
  underruns_reported,
  early_numbers_checked,
  doubtful_numbers_checked,
  missed_numbers_counted,
  one_axis_is_the_clock,
  path_place_is_unique,
  wrong_segments_stop,

  // Rights and limits of motions
  leases_expire,
  lease_keeps_others_out,
  lease_axes,
  lease_asked_at_turn,
  lease_asked_as_bytes_go,
  latch_of_lease,
  latch_without_lease,
  own_stop_holds_nobody_back,
  passed_epochs_refused,
  passed_frames_refused,
  travel_bounded,
  speed_bounded,
  overrides_for_some,
  homing_required,
  stage_of_profile,
  jog_needs_renewal,
  jog_ends_before_bound,
  jog_ends_with_its_right,
  orphans_stopped,
  inputs_start_nothing,
  non_host_alone,
  switches_audited,
  notices_distinguished,
  notices_bounded,
  excitation_known,
  circle_seen_to_run,
  inputs_read_twice,
  scans_disarm,
  settings_restored,
  pending_speeds_restored,

  // Bounds of queues and waits
  lanes_bounded,
  shares_bounded,
  waiting_lines_expire,
  waiting_motions_expire,
  unread_lines_bounded,
  lanes_starve_not,
  callers_take_turns,
  motions_not_overtaken,
  questions_have_turns,
};
inline constexpr int kGuards = static_cast<int>(Guard::questions_have_turns) + 1;

#ifdef AXISGATE_REMOVABLE_GUARDS
inline std::optional<Guard> removed_guard;
inline bool guarded(Guard guard) { return removed_guard != guard; }
#else
constexpr bool guarded(Guard) { return true; }
#endif

}  // namespace axisgate
