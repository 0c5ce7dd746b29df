// Load of the tool in a job: cutting speed, depth of one pass, and volume removed.
#pragma once

#include <optional>
#include <vector>

#include "device/rml1/check/height_map.h"
#include "device/rml1/machine/machine.h"

namespace axisgate::rml1 {

// A Section is everything that is cut with one speed, either along or straight down.
struct Section {
  bool plunges = false;  // straight down
  double speed = 0;      // mm/s, as set and limited to the machine's; 0: further speeds
  jobs::Place first;     // place of its first command
  double cutting_mm = 0;
  double deepest_mm = 0;                // below Z0
  double pass_mm = 0;                   // greatest depth of one pass
  std::optional<double> removed_mm3{};  // nullopt if the tool is unknown, or the map has no room for the job
};

// Not thread safe.
class Workload {
 public:
  // `tool_mm`: diameter, above 0. If it is nullopt, 2 mm are assumed, and no volume is given.
  Workload(const Profile& profile, std::optional<double> tool_mm);

  // Takes over the material removed in `before`, cut with a tool of the same diameter. Call before moved().
  void continues(Workload& before);
  // Returns the depth that the move cuts in one pass, in mm; 0 if it does not cut. `speed`: the speed set, in mm/s.
  double moved(const Move& move, double speed);
  // Sections in the order of their beginnings; at most kSections.
  const std::vector<Section>& sections() const { return sections_; }

  static constexpr std::size_t kSections = 12;

 private:
  Section& section(bool plunges, double speed, const jobs::Place& place);

  double step_mm_;
  bool tool_known_;
  HeightMap map_;
  std::vector<Section> sections_;
};

}  // namespace axisgate::rml1
