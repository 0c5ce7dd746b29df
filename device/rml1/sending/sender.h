// Sender of a job, from its first byte to its last, with pause and abort. README.md has the table of its states.
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

// Returns the state after the event; nullopt if the table does not allow the event.
std::optional<jobs::SenderState> next(jobs::SenderState state, SendEvent event);

// A MillLine is the line to a mill, with the other objects that all writers to this line share.
struct MillLine {
  FlowLink& line;
  Abort& abort;
  Violations& violations;
};

// A Sender sends one job. Not thread safe. Each call may change the state. `now` must never decrease.
class Sender {
 public:
  // `job`: checked bytes with prologue and epilogue. `plan`: plan_of() this job with these settings. The referenced
  // objects must outlive this one.
  Sender(std::string_view job, const Timeline& timeline, const Profile& profile, const jobs::SendSettings& settings,
         const SendPlan& plan, const MillLine& mill);

  jobs::RunOn run_on() const { return plan_.run_on; }

  // A request that the present state does not allow has no effect.
  void start(TimePoint now);
  void pause();
  void resume(TimePoint now);
  // Stops sending the job, and writes the commands that raise the tool and stop the spindle after the last sent byte.
  void raise();
  // Stops sending the job, and writes the abort.
  void abort(TimePoint now);
  void line_lost();

  void advance(TimePoint now);
  // Time at which advance() must be called next; nullopt if only another call can change the sender.
  std::optional<TimePoint> next_deadline(TimePoint now) const;

  jobs::SenderState state() const { return state_; }
  jobs::SendProgress progress(TimePoint now);
  // Returns the number of bytes of the job that the slowest mill has executed. If bytes cannot leave the host, the mill
  // may be paused at its panel: then returns at most the number of bytes that have left the host, minus the sizes of
  // the mill's buffer and of a converter.
  std::uint64_t executed_for_certain(TimePoint now);
  // Reports whether the mill may have dropped the abort because its buffer was full. This is possible without flow
  // control if the written bytes and the abort exceed the buffer, because the mill may have been paused at its panel
  // all the time. With flow control, the mill stops its host while it still has room.
  bool abort_may_be_dropped() const;
  // Measured pace of the mill. nullopt with paced streaming, or before the line has been stopped long enough to measure
  // it.
  std::optional<jobs::MeasuredPace> measured_pace() const { return meter_.pace(); }

  // Longest time between two checks of a line that has bytes to send or is held.
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
  TimePoint next_check(TimePoint due, TimePoint now) const;
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
  Cutter cutter_;            // the bytes before its begin() were written
  std::uint64_t taken_ = 0;  // SendProgress::taken
  TimePoint leaves_{};       // when the last written byte leaves the host, if nothing stops the line
  TimePoint arrives_{};      // when the last written byte reaches the mill; later than leaves_ if a converter delays it
  std::optional<TimePoint> raised_at_;  // latest end of the raise; nullopt until all sent bytes have been executed
};

}  // namespace axisgate::rml1
