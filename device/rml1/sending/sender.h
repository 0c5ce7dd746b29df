// Sends a job from its first byte to its last, with pause and abort. README.md has the table of its states.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/line_machine.h"
#include "device/core/time.h"
#include "device/core/violations.h"
#include "device/jobs/send_settings.h"
#include "device/jobs/sending.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/sending/abort.h"
#include "device/rml1/sending/cut.h"
#include "device/rml1/sending/pace.h"
#include "device/rml1/sending/pace_meter.h"
#include "device/rml1/sending/plan.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

enum class SendEvent { start, pause, resume, raise, all_written, all_executed, abort, abort_left, line_lost };
std::string_view name(SendEvent event);  // "start", as in README.md
inline constexpr std::size_t kSendEvents = 9;

// Returns the state after the event; nullopt if the table has none.
std::optional<jobs::SenderState> next(jobs::SenderState state, SendEvent event);

// A MillLine is what a sender shares with everything else that writes to the mill.
struct MillLine {
  FlowLink& line;
  Abort& abort;
  Violations& violations;
};

// Not thread safe. Each call may change the state; `now` never goes back.
class Sender {
 public:
  // `job`: with prologue and epilogue, checked. `plan`: of the job and the settings. The referenced objects must
  // outlive this one.
  Sender(std::string_view job, const Timeline& timeline, const Profile& profile, const jobs::SendSettings& settings,
         const SendPlan& plan, const MillLine& mill);

  jobs::RunOn run_on() const { return plan_.run_on; }

  // A call that the present state does not allow has no effect.
  void start(TimePoint now);
  void pause(TimePoint now);
  void resume(TimePoint now);
  // Sends no more of the job, and raises the tool after the last sent byte.
  void raise(TimePoint now);
  // Ends the writing of the job and requests the abort.
  void abort(TimePoint now);
  void line_lost(TimePoint now);

  void advance(TimePoint now);
  // Returns when to call advance() again; nullopt: not before another call.
  std::optional<TimePoint> next_deadline(TimePoint now) const;

  jobs::SenderState state() const { return state_; }
  jobs::SendProgress progress(TimePoint now);
  // Bytes of the job that the mill has executed even if its panel holds it: while the line is stopped, all that has
  // left the host but what the mill's buffer and a converter hold.
  std::uint64_t executed_for_certain(TimePoint now);
  // Reports whether the mill's buffer may have been full when the abort came, so that the mill may have dropped it: its
  // panel may have held it all the time. A mill with flow control stops its host while it still has room.
  bool abort_may_be_dropped() const;
  // Measured pace of the mill. nullopt with paced streaming, or before the line has been stopped long enough to measure
  // it.
  std::optional<jobs::MeasuredPace> measured_pace() const { return meter_.pace(); }

  // Between two looks at a line that has something to send, or is held, at most.
  static constexpr Duration kLook = std::chrono::milliseconds(5);

 private:
  bool request(SendEvent event);
  void change(SendEvent event);
  void send(TimePoint now);
  void write(TimePoint now);
  bool has_room(TimePoint now);
  void learn(TimePoint now);
  void learn_what_waits(TimePoint now);
  bool heeds_flow_control() const;
  void measure(TimePoint now);
  bool all_is_executed(TimePoint now);
  bool has_raised(TimePoint now);
  bool rests_after_written() const;
  bool is_blocked() const;
  Duration until_next_look() const;
  TimePoint look_before(TimePoint due, TimePoint now) const;
  TimePoint room_at() const;
  bool may_rest(TimePoint now);

  const std::string_view job_;
  const Timeline& timeline_;
  const Profile& profile_;
  const jobs::SendSettings settings_;
  const SendPlan plan_;
  FlowLink& line_;
  Abort& abort_;
  Violations& violations_;
  Pace slowest_, fastest_;
  PaceMeter meter_;
  jobs::SenderState state_ = jobs::SenderState::ready;
  Cutter cutter_;  // written up to its begin()
  std::uint64_t taken_ = 0;
  TimePoint leaves_{};                  // the last of them, the host, if nothing stops the line
  TimePoint arrives_{};                 // likewise, at the mill: a converter may hold what has left the host
  std::optional<TimePoint> raised_at_;  // at the latest; nothing: what was sent of the job may not have been executed
};

}  // namespace axisgate::rml1
