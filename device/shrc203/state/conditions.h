// Detects conditions that begin or end at the stage by comparing each reading with the earlier ones: an emergency stop,
// a limit sensor, an error, a motor, the mode, the command format.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "device/shrc203/stage.h"
#include "device/stage/condition.h"

namespace axisgate::shrc203 {

class Conditions {
 public:
  using Changes = std::vector<ConditionChanged>;
  using ByAxis = std::map<int, stage::ConditionBits>;

  // Compares a reading with the known state. A status bit or the state of a motor has changed when two readings in a
  // row show the change, since one flipped bit on the line makes another number. The time of the first of the two
  // counts.
  Changes status_read(const ByAxis& shown, TimePoint now) { return status_.compare(shown, now); }
  Changes motors_read(const ByAxis& shown, TimePoint now) { return motors_.compare(shown, now); }
  // Compares the mode or the command format with the known one. One reading decides, since no flipped bit turns one
  // mode into another. Q: is answered in HOST only (manual 4.).
  Changes mode_read(std::string_view mode, TimePoint now);
  Changes format_read(std::string_view format, TimePoint now);

  // Reports whether the last reading differs from the known state, so that another one should follow soon.
  bool status_doubtful() const { return status_.doubtful(); }
  bool motors_doubtful() const { return motors_.doubtful(); }
  TimePoint motors_last_read() const { return motors_.read; }

 private:
  struct Compared {
    Changes compare(const ByAxis& shown, TimePoint now);
    bool doubtful() const;

    std::array<stage::ConditionBits, kAxisCount> known{}, differing{};  // `differing`: in the last reading
    TimePoint read{}, before{};                                         // times of the last reading and the one before
  };
  // A Selected is a front panel setting, as text.
  struct Selected {
    Changes compare(stage::Condition condition, std::string_view now_selected, TimePoint now);

    const std::string needed;
    std::string known = needed;
    TimePoint read{};
  };

  Compared status_, motors_;
  Selected mode_{"HOST"}, format_{"SHOT_FC"};
};

}  // namespace axisgate::shrc203
