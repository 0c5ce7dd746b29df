// Settings to restore: speeds, outputs and trigger that a motion or the holder of a lease has set, and that the
// controller would keep. This list determines the commands; session/restorer.cc sends them.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "device/shot/command/command.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// Returns the speeds, or those of the mechanical origin return, of the axes for which they are known.
commands::Speeds known_speeds(const State& state, AxisSet axes);
commands::Speeds known_origin_speeds(const State& state, AxisSet axes);

enum class RestoredSetting { speeds, origin_speeds, outputs, trigger };

struct PendingRestore {
  using Value = std::variant<SpeedSetting, int, Trigger>;

  RestoredSetting setting = RestoredSetting::speeds;
  int axis = 0;             // for speeds; 0 for settings of the whole controller
  std::uint64_t lease = 0;  // lease whose holder changed the setting; 0 if a motion did
  Value before;
  std::optional<Value> set;  // newest value set; nullopt for speeds, which are restored whatever they are now
  std::uint64_t epoch = 0;   // device epoch of the newest change under the lease
};

class PendingRestores {
 public:
  using Speeds = commands::Speeds;

  // Settings that a line is about to change.
  struct Change {
    AxisSet speeds, origin_speeds;
    std::optional<int> outputs;
    std::optional<Trigger> trigger;
    bool empty() const { return speeds.empty() && origin_speeds.empty() && !outputs && !trigger; }
  };

  // Returns the speeds of a motion that restores them itself.
  static PendingRestores of_motion(const Speeds& before);

  // Remembers the present values of the settings. Call before the line is sent. Settings that are already pending keep
  // their older value.
  void remember(std::uint64_t lease, const Change& change, const State& state);
  void remember_scan(const Trigger& before, const Trigger& armed);

  // Removes and returns the speeds that motions changed on these axes, to be restored now. keep() adds the failed ones
  // again, for the next motion.
  PendingRestores take(AxisSet axes);
  void keep(const PendingRestores& failed);
  PendingRestores take_leases();
  PendingRestores of_lease(std::uint64_t lease) const;
  PendingRestores of_scan() const;

  // Forgets settings that motions have changed: they were restored, or somebody else has set them.
  void forget_speeds(AxisSet axes);
  void forget_scan();
  void forget_lease(std::uint64_t lease);

  bool empty() const { return list_.empty(); }
  bool has_scan() const { return find(RestoredSetting::trigger, 0, 0) != nullptr; }
  std::vector<std::uint64_t> leases() const;  // in ascending order
  Speeds speeds() const;
  AxisSet sped() const;  // the axes of speeds()
  // Returns the axes that must be stationary to restore the settings: D:, B: and T: are refused while they move (manual
  // 89), 94), 97)); O: never is.
  AxisSet stationary_axes() const;

  // Reports whether the setting must be read first: only the present trigger shows whether a scan has left it armed.
  bool must_read_first(RestoredSetting setting, const State& state) const;
  // Returns the command that restores the setting; nullopt if it has its old value, or must stay as it is.
  std::optional<Command> command(RestoredSetting setting, const State& state) const;

 private:
  const PendingRestore* find(RestoredSetting setting, int axis, std::uint64_t lease) const;
  void add(const PendingRestore& one);

  std::vector<PendingRestore> list_;  // at most one entry for each setting, axis and lease
};

}  // namespace axisgate::shrc203
