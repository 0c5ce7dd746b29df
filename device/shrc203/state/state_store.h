// Known state of the controller: one State, which readers see, and facts beside it. Every new fact is noted here, so
// that each is written in one place.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/shot/command/reply.h"
#include "device/shot/line/link.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/conditions.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

// Reason why the link is not up, as far as decisions depend on it. State::link_problem is the text.
enum class LinkTrouble { none, line, mode, format, motion, other_unit };

// A StateStore runs on the controller's strand, like everything in this folder.
class StateStore {
 public:
  StateStore(const Profile& profile, EventSink& events, const Tasks& tasks)
      : profile_(profile), events_(events), tasks_(tasks) {}

  const State& state() const { return state_; }
  AxisSet controllable() const { return state_.controllable(); }
  const Profile& profile() const { return profile_; }
  Positions positions() const { return positions_of(state_); }
  Envelope envelope(const RequestContext& context) const { return {profile_, state_, context.who, context.role}; }

  void publish() { emit(StateChanged{}); }
  bool followed() const { return events_.state_followed(); }
  void emit(const Event& event) { events_.on_event(event, tasks_.now()); }

  // Link state. not_up() reports it together with the trouble.
  void show_link(LinkPhase phase) { state_.link = shown(phase); }  // the only writer of State::link
  bool line_works() const { return state_.link == LinkState::up || state_.link == LinkState::doubtful; }
  void note_trouble(LinkTrouble trouble, std::string words);
  void note_trouble(LinkTrouble trouble) { trouble_ = trouble; }
  LinkTrouble trouble() const { return trouble_; }
  // Reports whether somebody must change the mode or the format at the front panel before the link can be up.
  bool panel_is_wrong() const { return trouble_ == LinkTrouble::mode || trouble_ == LinkTrouble::format; }
  void note_wrong_panel();
  Problem not_up() const;  // link_down or wrong_mode; the hint fits the trouble

  // Counts connects and losses, so that a procedure notices a new one.
  std::uint64_t connection() const { return connection_; }
  void connected() { ++connection_; }
  // Forgets positions, outputs and trigger when the line is lost. Axes that moved may still move.
  void lost();
  void may_move_unseen() { state_.moving_unknown = true; }

  // Results of the handshake.
  void identified(const Identity& identity);
  // Returns the serial number that has passed a handshake; empty before the first.
  const std::string& unit() const { return unit_; }
  // Returns the serial number that must answer: the configured one, or that of the previous unit. Empty: any.
  const std::string& expected_unit() const { return profile_.serial_number.empty() ? unit_ : profile_.serial_number; }
  bool is_expected(const Identity& identity) const;
  void note_mode(std::string mode);
  void note_format(std::string format);
  void note_controllable(AxisSet axes);
  // Begins a device epoch when the handshake has passed. Returns its number.
  std::uint64_t begin_epoch();
  // Raises the frame epoch. The axes count as not homed, because the travel limits count from the homing origin and the
  // new coordinates do not.
  void shift_frame(AxisSet axes);
  void note_homed(AxisSet axes);

  // A Read is the axes that a reading shows as READY, and those that it shows as busy.
  struct Read {
    AxisSet ready, busy;
  };
  // Notes a reading of the positions. Returns nullopt, and notes nothing, if the reply makes no sense.
  std::optional<Read> note_positions(const Reply& reply);
  // Marks axes in foreign motion: busy, and not ours. Two readings in a row must show it, since one flipped bit turns
  // an R into a B.
  void note_foreign_motion(AxisSet busy, AxisSet ours);
  // Notes axes that the previous run started and that were not seen stationary yet. Their motion is not foreign.
  void note_left_moving(AxisSet axes) { left_moving_ = axes; }
  AxisSet left_moving() const { return left_moving_; }
  // Notes the fields of the reply to ?:C, by axis (manual 33)).
  void note_excitation(const std::map<int, std::string>& fields);
  void note_outputs(std::optional<int> outputs) { state_.outputs = outputs; }
  void note_trigger(std::optional<Trigger> trigger) { state_.trigger = std::move(trigger); }
  void note_armed(AxisSet axes, bool armed);
  void note_open_stops(std::vector<Stop> stops) { state_.open_stops = std::move(stops); }
  void note_emergency(std::optional<EmergencyLatch> latch) { state_.emergency = std::move(latch); }
  // `reported` is the reply to ?:P.
  void note_scale(int axis, const Scale& scale) { state_.axis(axis).scale = scale; }
  void note_reported_scales(std::string reported) { reported_scales_ = std::move(reported); }
  const std::string& reported_scales() const { return reported_scales_; }

  // Notes the speeds that D: sets, as do prebuffer settings with speeds (manual 68)). Speeds that D: cannot set were
  // misread and become unknown.
  void note_speeds(const commands::Speeds& speeds);
  void forget_speeds(AxisSet axes);
  void note_origin_speeds(int axis, const std::optional<SpeedSetting>& speed);
  commands::Speeds speeds(AxisSet axes) const;
  commands::Speeds origin_speeds(AxisSet axes) const;
  bool speeds_known(AxisSet axes) const { return speeds(axes).size() == static_cast<std::size_t>(axes.count()); }
  bool origin_speeds_known(AxisSet axes) const {
    return origin_speeds(axes).size() == static_cast<std::size_t>(axes.count());
  }

  // Returns the conditions at the stage. Their changes are emitted with the reading that shows them.
  const Conditions& conditions() const { return conditions_; }

  // Returns the reason why the link is not up, as text; never empty.
  std::string link_problem() const;

  // Reports whether the last reading was READY and nothing has happened since.
  bool settled() const { return settled_; }
  void settle() { settled_ = true; }
  void unsettle() { settled_ = false; }

 private:
  std::string remedy() const;
  void emit_all(const Conditions::Changes& changes);

  const Profile& profile_;
  EventSink& events_;
  const Tasks& tasks_;
  State state_;
  Conditions conditions_;
  std::string unit_;
  std::string reported_scales_;
  LinkTrouble trouble_ = LinkTrouble::none;
  std::uint64_t connection_ = 0;
  AxisSet moved_unasked_;  // busy at the last reading, and not by a known motion
  AxisSet left_moving_;    // see note_left_moving()
  bool settled_ = false;
};

}  // namespace axisgate::shrc203
