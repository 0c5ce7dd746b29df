// The life of a motion: where its procedure is, and what has come between. Two enums, each changed in one place by a
// table of README.md. What callers see (Motion::state) is computed from both.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "device/stage/motion.h"

namespace axisgate::shrc203 {

enum class MotionPhase {
  queued,     // waits for its turn on its axes
  preparing,  // has its turn; none of its lines has gone out
  resting,    // shown as running: waits before its first segment, none of its lines has gone out
  setting,    // its lines go out; the registers may hold something of it
  running,    // its start was accepted, or its axes were seen to move
  restoring,  // has its outcome, and keeps its axes until what it changed is restored
  ended,      // has its outcome, and has left its axes
};
inline constexpr std::size_t kMotionPhases = 7;

enum class MotionEvent {
  entered,              // its turn has come
  written,              // a line of its own goes out
  started,              // its start was accepted, or its axes move; of one that rests first: it begins to
  finished,             // it has its outcome
  finished_to_restore,  // it has its outcome, and what it changed is to be restored
  left,                 // all of that is restored
};
inline constexpr std::size_t kMotionEvents = 6;

std::string_view name(MotionPhase phase);  // "queued", as in README.md
std::string_view name(MotionEvent event);
// The phase after the event; nothing where the table has none.
std::optional<MotionPhase> next(MotionPhase phase, MotionEvent event);

// What has come from outside. The line counts only for a motion that has its turn.
enum class Interruption { none, stop, line_lost, stop_and_line_lost };
inline constexpr std::size_t kInterruptions = 4;
enum class InterruptionEvent { stop_asked, line_lost };
inline constexpr std::size_t kInterruptionEvents = 2;

std::string_view name(Interruption interruption);
std::string_view name(InterruptionEvent event);
// Always another interruption, or the same: what comes from outside is never illegal.
Interruption next(Interruption interruption, InterruptionEvent event);

class MotionLife {
 public:
  MotionPhase phase() const { return phase_; }
  Interruption interruption() const { return interruption_; }

  bool has_turn() const { return phase_ >= MotionPhase::preparing && phase_ <= MotionPhase::restoring; }
  bool has_written() const { return phase_ == MotionPhase::setting || phase_ == MotionPhase::running; }
  bool has_outcome() const { return phase_ >= MotionPhase::restoring; }
  // Not yet shown as running.
  bool unstarted() const;

  bool stop_asked() const;
  bool line_lost() const;
  const std::string& stopped_by() const { return stopped_by_; }      // who asked last
  const std::string& line_problem() const { return line_problem_; }  // why the line was lost

  // Of a motion without an outcome.
  stage::MotionState shown() const;

  // False for an event that the phase does not permit: the phase stays.
  [[nodiscard]] bool happened(MotionEvent event);
  void stop(std::string who);
  void lose_line(std::string why);

 private:
  MotionPhase phase_ = MotionPhase::queued;
  Interruption interruption_ = Interruption::none;
  std::string stopped_by_, line_problem_;
};

}  // namespace axisgate::shrc203
