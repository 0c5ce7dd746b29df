// Recognises a job that was made for another machine, or in another unit: a job states neither.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "device/jobs/extent.h"
#include "device/jobs/point.h"
#include "device/rml1/check/unit_clues.h"
#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/instruction.h"
#include "device/rml1/machine/known_machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// Each doubt is reported once. Not thread safe.
class ProfileJudge {
 public:
  // The referenced objects must outlive this one. `made_for`: name of the machine that the job was made for, if
  // somebody has named one; empty: the job is judged by its content.
  ProfileJudge(const Profile& profile, const std::vector<KnownMachine>& others, std::string_view made_for,
               Diagnostics& diagnostics)
      : profile_(profile), others_(others), made_for_(made_for), diagnostics_(diagnostics) {}

  // Takes the first bytes of the file.
  void begins(std::string_view head);
  void executed(const Instruction& instruction);
  // Takes a lift by `steps`, or to that height above Z0.
  void lifted(double steps, const Instruction& by);
  // Takes the end of a straight commanded path, in steps.
  void commanded(const jobs::Point& target, const Instruction& by);
  // Takes a path that leads below Z0, to the depth of `target`.
  void deepened(const jobs::Point& target, const Instruction& by);
  // `extent`: extent of the job on this machine.
  void finish(const jobs::Extent& extent);

  // Highest speed in mm/s that the job sets and the machine cannot reach; nullopt if there is none.
  std::optional<double> speed_not_reached() const { return speed_not_reached_; }

 private:
  // A Suspicion is a sign that the job was made for machines with this step.
  struct Suspicion {
    std::string why;
    std::string names;  // names of these machines: "MDX-15 and the MDX-20"
    double step_mm = 0;
    jobs::Place place;
  };

  void suspect(std::string why, const std::vector<std::string>& names, double step_mm, const jobs::Place& place);
  void suspect_as_said();
  double odds_of(double step_mm) const;
  void suspect_by_clues();
  void judge_raster();
  void judge_speed(const Instruction& instruction, double highest, bool& reported);
  std::string machines_as_fast(double speed) const;
  void take_coordinate(double steps);

  const Profile& profile_;
  const std::vector<KnownMachine>& others_;
  const std::string_view made_for_;
  Diagnostics& diagnostics_;
  std::optional<Suspicion> suspicion_;  // the first one
  bool named_ = false;                  // the file names this machine
  UnitClues clues_;
  std::uint64_t paths_ = 0;
  bool own_travel_ = false;          // the job has a lift by the whole travel of this machine
  std::optional<Suspicion> travel_;  // the job has a lift by the whole travel of machines with another step
  std::optional<jobs::Place> deep_;  // place of the first path that leads below Z0
  bool plane_speed_reported_ = false, height_speed_reported_ = false;
  std::optional<double> speed_not_reached_;
  std::int64_t raster_ = 0;           // greatest common divisor of all X and Y, in steps
  std::set<std::int64_t> different_;  // different X and Y, as many as are needed
  std::optional<jobs::Place> first_;  // place of the first path with X and Y
};

}  // namespace axisgate::rml1
