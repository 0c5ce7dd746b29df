// Warnings that save a workpiece, based on the commanded path and on the driven path.
#pragma once

#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "device/jobs/bounds.h"
#include "device/jobs/stock.h"
#include "device/rml1/check/profile_judge.h"
#include "device/rml1/machine/machine.h"

namespace axisgate::rml1 {

// Each warning is given once, at the first command that causes it.
class Judge {
 public:
  // The referenced objects must outlive this one.
  Judge(const Profile& profile, bool origin_known, std::optional<jobs::Stock> stock,
        const std::vector<KnownMachine>& others, Diagnostics& diagnostics)
      : profile_(profile), origin_known_(origin_known), stock_(stock), others_(others), diagnostics_(diagnostics) {}

  void moved(const Move& move);
  void commanded(const jobs::Point& from, const jobs::Point& target, bool height_alone, const Box& box,
                 const Instruction& by);
  // Takes the depth that `move` cuts in one pass, in mm.
  void took(double depth_mm, const Move& move);
  void finish(const Machine& machine, std::uint64_t commands);

 private:
  template <class Text>
  void warn_once(Warning warning, const jobs::Place& place, std::string_view section, Text&& text);
  void judge_stock(const Move& move);
  void take_plane(const jobs::Point& from, const jobs::Point& target, const jobs::Place& place);
  void judge_area(const jobs::Point& target, const Box& box, const jobs::Place& place);
  void judge_sizes();
  void judge_errors(std::uint64_t commands);
  bool fits(double size, double area_mm, double step_mm) const;
  double mm(double steps) const { return steps * profile_.step_mm; }

  const Profile& profile_;
  bool origin_known_;
  std::optional<jobs::Stock> stock_;
  const std::vector<KnownMachine>& others_;
  Diagnostics& diagnostics_;
  std::set<Warning> reported_;
  bool travel_reported_ = false;  // a travel outside the work area was reported
  jobs::Bounds asked_;            // bounds of the commanded path; if the origin is known, X and Y of cuts alone
  jobs::Place widest_x_, widest_y_, deepest_;
  std::optional<jobs::Place> last_;
  std::uint64_t paths_before_errors_ = 0;
};

}  // namespace axisgate::rml1
