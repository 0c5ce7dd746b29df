#include "device/shrc203/session/restorer.h"

#include <array>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/lease_settings.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::array kSpeeds{RestoredSetting::speeds};
constexpr std::array kOutputs{RestoredSetting::outputs};
constexpr std::array kTrigger{RestoredSetting::trigger};
constexpr std::array kBothSpeeds{RestoredSetting::speeds, RestoredSetting::origin_speeds};
constexpr std::array kAllButSpeeds{RestoredSetting::origin_speeds, RestoredSetting::outputs, RestoredSetting::trigger};

// Reports whether the restore waits for the line. Speeds stay pending instead: the next motion on their axes restores
// them.
constexpr bool waits_for_line(RestoredSetting setting) { return setting != RestoredSetting::speeds; }
// Reports whether the setting is read if it cannot be restored. Motions are computed from speeds, so their state must
// be true.
constexpr bool read_when_not_restored(RestoredSetting setting) { return setting == RestoredSetting::speeds; }

ExchangeRequest request_for(const std::string& caller) {
  ExchangeRequest request;
  request.lane = Lane::motion;
  request.caller = caller;
  return request;
}

}  // namespace

// Restores the settings in this order, until all have their old values or no try is left. Returns whether all are
// restored. `request` names the caller.
Task<bool> Restorer::restore(PendingRestores what, std::span<const RestoredSetting> order, int tries,
                             ExchangeRequest request) {
  bool restored = false;
  for (int attempt = 0; attempt < tries && !restored; ++attempt) {
    // Another procedure has restored the trigger meanwhile, or somebody has set their own.
    if (what.has_scan() && !pending_.has_scan()) co_return true;
    restored = true;
    for (const RestoredSetting setting : order) {
      const bool one = co_await restore_one(what, setting, request);
      restored = restored && one;
    }
  }
  co_return restored;
}

Task<bool> Restorer::restore_one(PendingRestores what, RestoredSetting setting, ExchangeRequest request) {
  const std::string caller = request.caller;
  if (what.must_read_first(setting, store_.state())) {
    (void)co_await reader_.read_trigger(caller);
    if (!store_.state().trigger) co_return false;
  }
  const auto command = what.command(setting, store_.state());
  if (!command) co_return true;
  if (!store_.line_works() && !waits_for_line(setting)) co_return false;
  request.command = *command;
  request.not_after = tasks_.now() + (ending_ ? kEndRestoreWriteLimit : kStepWriteLimit);
  auto pending = dialogue_.exchange(std::move(request));
  const auto result = co_await pending;
  note_setting(store_, *command, result);
  if (result.accepted()) {
    if (setting == RestoredSetting::speeds) store_.note_speeds(what.speeds());
    co_return true;
  }
  if (ending_ || !read_when_not_restored(setting)) co_return false;
  const auto read = co_await reader_.read_speeds(caller);
  if (!read) store_.unsettle();
  co_return false;
}

// Speeds belong to one motion, but the controller keeps them (manual 68)), so the next user gets the earlier speeds
// back.
Task<void> Restorer::restore_after(LiveMotionPtr live) {
  if (!live->restores()) co_return;
  // The newest setting may have been accepted although its reply was lost.
  if (live->motion.state != MotionState::succeeded) store_.forget_speeds(live->motion.axes);
  auto request = dialogue_.request_of(*live, {}, Lane::motion);
  request.tidies = true;
  const auto what = PendingRestores::of_motion(live->speeds_before);
  const bool restored = co_await restore(what, kSpeeds, 1, std::move(request));
  if (!restored) pending_.keep(what);
  motions_.leave(*live);
}

Task<void> Restorer::restore_speeds(AxisSet axes, std::string caller) {
  const auto what = pending_.take(axes);
  const auto request = request_for(caller);
  const bool restored = co_await restore(what, kSpeeds, kRestoreTries, request);
  if (!restored) pending_.keep(what);
}

Task<bool> Restorer::restore_trigger(std::string caller) {
  if (!guarded(Guard::scans_disarm)) co_return true;
  const auto what = pending_.of_scan();
  const auto request = request_for(caller);
  const bool restored = co_await restore(what, kTrigger, kRestoreTries, request);
  if (restored) pending_.forget_scan();
  co_return !pending_.has_scan();
}

// Restores the settings in the lease's turn on the axes. D: and T: are refused while axes move (manual 89), 97)), which
// somebody at the front panel may cause; others have their turns meanwhile.
Task<bool> Restorer::restore_in_turn(EndedLease lease, PendingRestores what) {
  const AxisSet axes = what.stationary_axes();
  if (axes.empty()) co_return true;
  // Fencing tokens are far above any motion's id.
  auto turn = motions_.gate().enter(lease.token, axes, lease.who, TimePoint::max());
  const auto entered = co_await turn;
  if (!entered) co_return false;
  pending_.forget_speeds(what.sped());  // the lease's values are older than the motions'
  const auto request = request_for("the gateway on behalf of " + lease.who);
  const bool speeds = co_await restore(what, kBothSpeeds, 1, request);
  bool trigger = co_await restore_trigger(request.caller);
  if (trigger) trigger = co_await restore(what, kTrigger, 1, request);
  motions_.gate().leave(lease.token);
  const bool restored = speeds && trigger;
  co_return restored;
}

// Restores until all settings have their old values, or kLeaseRestoreLimit has passed on a working line.
Task<void> Restorer::restore_settings_of(EndedLease lease) {
  std::optional<TimePoint> abandon_at;
  const auto request = request_for("the gateway on behalf of " + lease.who);
  while (!ending_ && guarded(Guard::settings_restored)) {
    if (store_.line_works()) {
      const auto what = pending_.of_lease(lease.token);
      const bool outputs = co_await restore(what, kOutputs, 1, request);
      const bool rest = co_await restore_in_turn(lease, what);
      if (!abandon_at) abandon_at = tasks_.now() + kLeaseRestoreLimit;
      if ((outputs && rest) || tasks_.now() >= *abandon_at) break;
    } else {
      abandon_at.reset();
    }
    auto pause = tasks_.pause(kLeaseRestorePause);
    co_await pause;
  }
  if (!ending_) pending_.forget_lease(lease.token);  // restore_everything() restores them at the gateway's end
  permission_.settings_restored(lease.token, tasks_.now());
}

Task<void> Restorer::restore_everything() {
  const auto request = request_for("the gateway (it is ending)");
  co_await restore_speeds(kAllAxes, request.caller);
  pending_.forget_speeds(kAllAxes);
  (void)co_await restore_trigger(request.caller);
  const auto pending = pending_.take_leases();
  const auto leases = pending.leases();
  for (const std::uint64_t lease : leases) {
    const auto what = pending.of_lease(lease);
    (void)co_await restore(what, kSpeeds, kRestoreTries, request);
    (void)co_await restore(what, kAllButSpeeds, kRestoreTries, request);
  }
}

}  // namespace axisgate::shrc203
