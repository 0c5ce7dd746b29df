// What is to be as it was: the speeds, outputs and trigger that a motion or a lease's holder has set, which the
// controller keeps for good. A list that knows what to send; restore.cc sends it.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "device/shrc203/command/builders.h"
#include "device/shrc203/command/codec.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// The speeds of those of the axes where they are known; and those of the mechanical origin return.
commands::Speeds known_speeds(const State& state, AxisSet axes);
commands::Speeds known_origin_speeds(const State& state, AxisSet axes);

enum class RestoredSetting { speeds, origin_speeds, outputs, trigger };

struct PendingRestore {
  using Value = std::variant<SpeedSetting, int, Trigger>;

  RestoredSetting setting = RestoredSetting::speeds;
  int axis = 0;             // of speeds; 0: of the whole controller
  std::uint64_t lease = 0;  // whose holder has set another; 0: a motion has
  Value before;
  std::optional<Value> set;  // last; of speeds nothing: whatever they are by now, they are restored
  std::uint64_t epoch = 0;   // of the device, when something was last set under the lease
};

class PendingRestores {
 public:
  using Speeds = commands::Speeds;

  // What a line is about to set.
  struct Change {
    AxisSet speeds, origin_speeds;
    std::optional<int> outputs;
    std::optional<Trigger> trigger;
    bool empty() const { return speeds.empty() && origin_speeds.empty() && !outputs && !trigger; }
  };

  // A motion's, while it restores them by itself.
  static PendingRestores of_motion(const Speeds& before);

  // Before the line is sent. What is pending already was there before what is set by now.
  void remember(std::uint64_t lease, const Change& change, const State& state);
  void remember_scan(const Trigger& before, const Trigger& armed);

  // Those speeds of motions, to be restored now; and what could not be, for the next motion.
  PendingRestores take(AxisSet axes);
  void keep(const PendingRestores& failed);
  PendingRestores take_leases();
  PendingRestores of_lease(std::uint64_t lease) const;
  PendingRestores of_scan() const;

  // What motions have changed there is somebody's own by now, or as it was.
  void forget_speeds(AxisSet axes);
  void forget_scan();
  void forget_lease(std::uint64_t lease);

  bool empty() const { return list_.empty(); }
  bool has_scan() const { return find(RestoredSetting::trigger, 0, 0) != nullptr; }
  std::vector<std::uint64_t> leases() const;  // in their order
  Speeds speeds() const;
  AxisSet sped() const;  // the axes of speeds()
  // D:, B: and T: are refused while these move (manual 89), 94), 97)); O: never is.
  AxisSet stationary_axes() const;

  // Whether a scan is only known to have left its trigger armed when that has been read.
  bool must_read_first(RestoredSetting setting, const State& state) const;
  // What restores it; nothing where it is as it was, or is to be left as it is.
  std::optional<Command> command(RestoredSetting setting, const State& state) const;

 private:
  const PendingRestore* find(RestoredSetting setting, int axis, std::uint64_t lease) const;
  void add(const PendingRestore& one);

  std::vector<PendingRestore> list_;  // one of a setting, axis and lease
};

}  // namespace axisgate::shrc203
