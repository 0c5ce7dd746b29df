// What is known of the controller: one State, and what is known beside it. Everything that is learned is noted here, so
// that each fact is written in one place. Readers see State.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/command/reply.h"
#include "device/shrc203/line/link.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/conditions.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

// Why the link is not up, as far as anything is decided by it; State::link_problem has it in words.
enum class LinkTrouble { none, line, mode, format, motion, other_unit };

// On the controller's strand, like all of this folder.
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

  // The link. not_up() reports it together with the trouble.
  void show_link(LinkPhase phase) { state_.link = shown(phase); }  // what writes State::link
  bool line_works() const { return state_.link == LinkState::up || state_.link == LinkState::doubtful; }
  void note_trouble(LinkTrouble trouble, std::string words);
  void note_trouble(LinkTrouble trouble) { trouble_ = trouble; }
  LinkTrouble trouble() const { return trouble_; }
  // Whether somebody must correct it at the front panel before the link can be up.
  bool panel_is_wrong() const { return trouble_ == LinkTrouble::mode || trouble_ == LinkTrouble::format; }
  void note_wrong_panel();
  Problem not_up() const;  // link_down, wrong_mode; the hint fits the trouble

  // Counts connects and losses, so that a procedure notices a new one.
  std::uint64_t connection() const { return connection_; }
  void connected() { ++connection_; }
  // Nothing that was read is true any more, and what moved may move on.
  void lost();
  void may_move_unseen() { state_.moving_unknown = true; }

  // The handshake.
  void identified(const Identity& identity);
  // The serial number that has passed a handshake; empty before the first.
  const std::string& unit() const { return unit_; }
  // The serial number that must answer: the configured one, or that of the unit before; empty: any.
  const std::string& expected_unit() const { return profile_.serial_number.empty() ? unit_ : profile_.serial_number; }
  bool is_expected(const Identity& identity) const;
  void note_mode(std::string mode);
  void note_format(std::string format);
  void note_controllable(AxisSet axes);
  // The handshake has passed. What this answers is the device epoch.
  std::uint64_t begin_epoch();
  // The travel limits count from the origin that the axis has homed to: coordinates set since are from elsewhere.
  void shift_frame(AxisSet axes);
  void note_homed(AxisSet axes);

  // Readings. False, and nothing is noted, where they make no sense; `ready` and `busy` are the axes that are.
  struct Read {
    AxisSet ready, busy;
  };
  std::optional<Read> note_positions(const Reply& reply);
  // Of axes that are busy and none of ours: two readings must say it, since one flipped bit makes a B of an R.
  void note_foreign_motion(AxisSet busy, AxisSet ours);
  // Started by the run before this one, and not seen to be stationary yet: nothing foreign.
  void note_left_moving(AxisSet axes) { left_moving_ = axes; }
  AxisSet left_moving() const { return left_moving_; }
  // By axis, as ?:C is answered (manual 33)).
  void note_excitation(const std::map<int, std::string>& fields);
  void note_outputs(std::optional<int> outputs) { state_.outputs = outputs; }
  void note_trigger(std::optional<Trigger> trigger) { state_.trigger = std::move(trigger); }
  void note_armed(AxisSet axes, bool armed);
  void note_open_stops(std::vector<Stop> stops) { state_.open_stops = std::move(stops); }
  void note_emergency(std::optional<EmergencyLatch> latch) { state_.emergency = std::move(latch); }
  // `reported`: what ?:P was answered.
  void note_scale(int axis, const Scale& scale) { state_.axis(axis).scale = scale; }
  void note_reported_scales(std::string reported) { reported_scales_ = std::move(reported); }
  const std::string& reported_scales() const { return reported_scales_; }

  // The speeds that D: sets, also by the prebuffer settings that have some (manual 68)). What no D: can set was
  // misread, and is not known.
  void note_speeds(const commands::Speeds& speeds);
  void forget_speeds(AxisSet axes);
  void note_origin_speeds(int axis, const std::optional<SpeedSetting>& speed);
  commands::Speeds speeds(AxisSet axes) const;
  commands::Speeds origin_speeds(AxisSet axes) const;
  bool speeds_known(AxisSet axes) const { return speeds(axes).size() == static_cast<std::size_t>(axes.count()); }
  bool origin_speeds_known(AxisSet axes) const {
    return origin_speeds(axes).size() == static_cast<std::size_t>(axes.count());
  }

  // What has changed at the stage; its changes are emitted with the reading that shows them.
  const Conditions& conditions() const { return conditions_; }

  // Why the link is not up, for people: never empty.
  std::string link_problem() const;

  // The last reading was READY, and nothing has happened since.
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
  AxisSet moved_unasked_;
  AxisSet left_moving_;  // at the last reading
  bool settled_ = false;
};

}  // namespace axisgate::shrc203
