// State machines of a motion: the phase of its procedure, and interruptions from outside. Two enums, each changed in
// one place by a table of README.md. Motion::state, which callers see, is computed from both.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "device/stage/motion.h"

namespace axisgate::shrc203 {

enum class MotionPhase {
  queued,     // waits for its turn on its axes
  preparing,  // has its turn; none of its lines has been sent
  resting,    // shown as running: waits before its first segment, none of its lines has been sent
  setting,    // its lines are being sent; the registers may contain some of its settings
  running,    // its start was accepted, or its axes were seen to move
  restoring,  // has its outcome, and keeps its axes until its settings are restored
  ended,      // has its outcome, and has left its axes
};
inline constexpr std::size_t kMotionPhases = 7;

enum class MotionEvent {
  entered,              // its turn has come
  written,              // one of its lines is about to be sent
  started,              // its start was accepted, or its axes move; or its wait before the first segment begins
  finished,             // it has its outcome
  finished_to_restore,  // it has its outcome, and settings must be restored
  left,                 // its settings are restored
};
inline constexpr std::size_t kMotionEvents = 6;

std::string_view name(MotionPhase phase);  // "queued", as in README.md
std::string_view name(MotionEvent event);
// Returns the phase after the event; nullopt if the table has no such transition.
std::optional<MotionPhase> next(MotionPhase phase, MotionEvent event);

// Interruptions from outside. A lost line counts only for a motion that has its turn.
enum class Interruption { none, stop, line_lost, stop_and_line_lost };
inline constexpr std::size_t kInterruptions = 4;
enum class InterruptionEvent { stop_asked, line_lost };
inline constexpr std::size_t kInterruptionEvents = 2;

std::string_view name(Interruption interruption);
std::string_view name(InterruptionEvent event);
// Returns the interruption after the event. Every event is permitted.
Interruption next(Interruption interruption, InterruptionEvent event);

class MotionLife {
 public:
  MotionPhase phase() const { return phase_; }
  Interruption interruption() const { return interruption_; }

  bool has_turn() const { return phase_ >= MotionPhase::preparing && phase_ <= MotionPhase::restoring; }
  bool has_written() const { return phase_ == MotionPhase::setting || phase_ == MotionPhase::running; }
  bool has_outcome() const { return phase_ >= MotionPhase::restoring; }
  // Reports whether the motion is not yet shown as running.
  bool unstarted() const;

  bool stop_asked() const;
  bool line_lost() const;
  const std::string& stopped_by() const { return stopped_by_; }      // who requested the newest stop
  const std::string& line_problem() const { return line_problem_; }  // reason for the loss of the line

  // Returns the state that callers see. Valid only without an outcome.
  stage::MotionState shown() const;

  // Changes the phase. Returns false, without a change, if the phase does not permit the event.
  [[nodiscard]] bool happened(MotionEvent event);
  void stop(std::string who);
  void lose_line(std::string why);

 private:
  MotionPhase phase_ = MotionPhase::queued;
  Interruption interruption_ = Interruption::none;
  std::string stopped_by_, line_problem_;
};

}  // namespace axisgate::shrc203
