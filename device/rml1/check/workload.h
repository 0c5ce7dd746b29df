// What a job demands of the tool: at which speed it cuts, how deep in one pass, and how much it removes.
#pragma once

#include <optional>
#include <vector>

#include "device/rml1/check/height_map.h"
#include "device/rml1/machine/machine.h"

namespace axisgate::rml1 {

// All that is cut with one speed, along or straight down.
struct Section {
  bool plunges = false;  // straight down
  double speed = 0;      // mm/s, as set and within the machine's; 0: of further speeds
  Place first;           // the command with which it begins
  double cutting_mm = 0;
  double deepest_mm = 0;                // below Z0
  double pass_mm = 0;                   // at most in one pass
  std::optional<double> removed_mm3{};  // where the tool is known, and the map has room for the job
};

// Not thread safe.
class Workload {
 public:
  // `tool_mm`: the diameter, above 0. Without it 2 mm are assumed, and no volume is given.
  Workload(const Profile& profile, std::optional<double> tool_mm);

  // Takes over what the other one has removed, with a tool of the same diameter. Before moved().
  void continues(Workload& before);
  // What the move takes in one pass, in mm; 0 where it does not cut. `speed` is the one set, in mm/s.
  double moved(const Move& move, double speed);
  // In the order of their beginnings; at most kSections.
  const std::vector<Section>& sections() const { return sections_; }

  static constexpr std::size_t kSections = 12;

 private:
  Section& section(bool plunges, double speed, const Place& place);

  double step_mm_;
  bool tool_known_;
  HeightMap map_;
  std::vector<Section> sections_;
};

}  // namespace axisgate::rml1
