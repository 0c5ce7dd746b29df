// Whether a job was made for another machine, or for another unit: a job states neither.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/diagnostic.h"
#include "device/rml1/instruction.h"
#include "device/rml1/point.h"
#include "device/rml1/profile.h"

namespace axisgate::rml1 {

// A machine that the job may have been made for instead.
struct KnownMachine {
  std::string name;
  double step_mm = 0, z_mm = 0;
  double fastest = 0;  // mm/s, of F VS V !VZ; 0 where it is not known
};

// Each doubt is reported once, at the first command that causes it. Not thread safe.
class ProfileJudge {
 public:
  // Everything referred to outlives this.
  ProfileJudge(const Profile& profile, const std::vector<KnownMachine>& others, Diagnostics& diagnostics)
      : profile_(profile), others_(others), diagnostics_(diagnostics) {}

  // The first bytes of the file.
  void begins(std::string_view head);
  void executed(const Instruction& instruction);
  // A lift by so many steps, or to that height above Z0.
  void lifted(double steps, const Instruction& by);
  // The end of a straight commanded path, in steps.
  void commanded(const Point& target, const Instruction& by);
  void finish();

  // The highest speed in mm/s that the job sets and the machine does not have.
  std::optional<double> speed_not_reached() const { return speed_not_reached_; }

 private:
  void judge_speed(const Instruction& instruction, double highest, bool& reported);
  std::string machines_as_fast(double speed) const;
  void take_coordinate(double steps);

  const Profile& profile_;
  const std::vector<KnownMachine>& others_;
  Diagnostics& diagnostics_;
  bool lift_reported_ = false, plane_speed_reported_ = false, height_speed_reported_ = false;
  std::optional<double> speed_not_reached_;
  std::int64_t raster_ = 0;           // of all X and Y, in steps: their greatest common divisor
  std::set<std::int64_t> different_;  // of these, as many as are needed
  std::optional<Place> first_;        // where they begin
};

}  // namespace axisgate::rml1
