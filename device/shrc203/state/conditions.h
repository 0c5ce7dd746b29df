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

  // A status bit or the state of a motor has changed when two readings in a row show it, since one flipped bit of the
  // line makes another number. The time of the first of the two counts.
  Changes status_read(const ByAxis& shown, TimePoint now) { return status_.compare(shown, now); }
  Changes motors_read(const ByAxis& shown, TimePoint now) { return motors_.compare(shown, now); }
  // No flipped bit makes one mode of another, so that one reading decides. Q: is answered in HOST only (manual 4.).
  Changes mode_read(std::string_view mode, TimePoint now);
  Changes format_read(std::string_view format, TimePoint now);

  // Whether the last reading differs from what is known, so that another one should follow soon.
  bool status_doubtful() const { return status_.doubtful(); }
  bool motors_doubtful() const { return motors_.doubtful(); }
  TimePoint motors_last_read() const { return motors_.read; }

 private:
  struct Compared {
    Changes compare(const ByAxis& shown, TimePoint now);
    bool doubtful() const;

    std::array<stage::ConditionBits, kAxisCount> known{}, differing{};  // `differing`: of the last reading
    TimePoint read{}, before{};                                         // the last reading, and the one before
  };
  // What the front panel selects, as text.
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
