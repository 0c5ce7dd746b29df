#include "device/rml1/check/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace axisgate::rml1 {
namespace {

constexpr double kHalfStep = 0.5;
// Assumed: more than twice the diameter of the tools that these machines take for cutting.
constexpr double kDeepPassMm = 10;
// Assumed: ten paths without an error show that the file is a job, and three errors after them are not typing mistakes.
constexpr std::uint64_t kSoundPaths = 10, kManyErrors = 3;

bool same(double a, double b) { return std::abs(a - b) < 1e-9; }

}  // namespace

template <class Text>
void Judge::warn_once(Warning warning, const jobs::Place& place, std::string_view section, Text&& text) {
  if (reported_.insert(warning).second) diagnostics_.warn(warning, place, section, text);
}

void Judge::moved(const Move& move) {
  last_ = move.place;
  if (move.operation == Operation::plot && !move.lowered && move.from.z <= 0 && move.from.z == move.to.z) {
    const bool home = move.to.x == 0 && move.to.y == 0;
    warn_once(home ? Warning::drags_home : Warning::drags_tool, move.place, "3-2", [home] {
      return fmt::format("travels {}at Z2 = 0: with the tool on the surface of the workpiece", home ? "home " : "");
    });
  }
  if (!move.below_surface()) return;
  if (!move.turning && !move.lifts()) {
    warn_once(Warning::spindle_off, move.place, "5-2", [] {
      return "goes below the surface while the spindle is off: !MC0 forbids it, and !MC1 permits it again";
    });
  }
  if (stock_) judge_stock(move);
}

void Judge::judge_stock(const Move& move) {
  const double x = profile_.steps(stock_->x) + kHalfStep, y = profile_.steps(stock_->y) + kHalfStep;
  const double bottom = -profile_.steps(stock_->z) - kHalfStep;
  // The stock is convex, so a cut below the surface lies inside if both of its ends do.
  for (const jobs::Point& p : {sunk(move.from, move.to), sunk(move.to, move.from)}) {
    if (p.x < -kHalfStep || p.y < -kHalfStep || p.x > x || p.y > y) {
      warn_once(Warning::outside_stock, move.place, "5-1", [&] {
        return fmt::format("below the surface outside of the stock, towards X {:.2f} mm, Y {:.2f} mm", mm(p.x),
                           mm(p.y));
      });
    }
    if (p.z < bottom) {
      warn_once(Warning::below_stock, move.place, "5-1", [&] {
        return fmt::format("{:.2f} mm deep, and the stock is {:.2f} mm thick: it cuts into what lies below", -mm(p.z),
                           stock_->z);
      });
    }
  }
}

void Judge::commanded(const jobs::Point& from, const jobs::Point& target, bool height_alone, const Box& box,
                      const Instruction& by) {
  const bool cuts = from.z < 0 || target.z < 0;
  if (diagnostics_.count(Severity::error) == 0) ++paths_before_errors_;
  if (!asked_.z.any || target.z < asked_.z.lowest) deepest_ = by.place;
  asked_.z.take(target.z);
  // Takes the beginning of a cut, but not the beginning of a travel, which is unknown. If the origin is known, a travel
  // is not taken at all: judge_area() sees the part of it that is left out.
  if (cuts || (!height_alone && !origin_known_)) take_plane(cuts ? from : target, target, by.place);
  if (origin_known_) judge_area(target, box, by.place);
}

void Judge::take_plane(const jobs::Point& from, const jobs::Point& target, const jobs::Place& place) {
  const jobs::Bounds before = asked_;
  for (const jobs::Point& p : {from, target}) {
    asked_.x.take(p.x);
    asked_.y.take(p.y);
  }
  if (asked_.x.size() > before.x.size()) widest_x_ = place;
  if (asked_.y.size() > before.y.size()) widest_y_ = place;
}

void Judge::judge_area(const jobs::Point& target, const Box& box, const jobs::Place& place) {
  if (!box.over(target)) {
    const bool cuts = target.z < 0;
    const auto text = [&] {
      return fmt::format("leaves the work area to X {:.2f} mm, Y {:.2f} mm: {}", mm(target.x), mm(target.y),
                         !cuts                          ? "it is not driven there"
                         : profile_.holds_flat_commands ? "it cuts along the edge instead"
                                                        : "what lies outside is not cut");
    };
    if (cuts) warn_once(Warning::cut_outside_area, place, "5-1", text);
    if (!cuts && !std::exchange(travel_reported_, true)) diagnostics_.note(place, "5-1", text);
  } else if (target.z < box.lowest.z) {
    warn_once(Warning::below_reach, place, "5-1", [&] {
      return fmt::format("{:.2f} mm below the surface, and the machine reaches {:.2f} mm: it cuts less deep",
                         -mm(target.z), -mm(box.lowest.z));
    });
  }
}

void Judge::took(double depth_mm, const Move& move) {
  if (depth_mm <= kDeepPassMm) return;
  warn_once(Warning::deep_pass, move.place, "3-2", [&] {
    return fmt::format("takes {:.2f} mm in one pass: with most tools a pass of this depth breaks the tool", depth_mm);
  });
}

bool Judge::fits(double size, double area_mm, double step_mm) const { return size * step_mm <= area_mm + step_mm / 2; }

void Judge::judge_sizes() {
  // Heights above the top are clipped (3-2 PU), so they do not count as a size.
  jobs::Reach depth;
  depth.take(0);
  depth.take(std::min(0.0, asked_.z.lowest));
  struct Size {
    std::string_view axis;
    double steps, area_mm;
    jobs::Place place;
  };
  const Size sizes[] = {{"X", asked_.x.size(), profile_.x_mm, widest_x_},
                        {"Y", asked_.y.size(), profile_.y_mm, widest_y_},
                        {"Z", depth.size(), profile_.z_mm, deepest_}};
  std::optional<jobs::Place> first;
  for (const Size& size : sizes) {
    if (fits(size.steps, size.area_mm, profile_.step_mm)) continue;
    if (!first) first = size.place;
    diagnostics_.error(0, size.place, "5-1", [&] {
      return fmt::format("larger than the machine: {:.2f} mm in {}, where the {} has {:.2f} mm", mm(size.steps),
                         size.axis, profile_.name, size.area_mm);
    });
  }
  std::set<double> steps;
  for (const KnownMachine& other : others_) steps.insert(other.step_mm);
  for (const double step : steps) {
    const auto fits_then = [&](const Size& size) { return fits(size.steps, size.area_mm, step); };
    if (!first || same(step, profile_.step_mm) || !std::ranges::all_of(sizes, fits_then)) continue;
    diagnostics_.warn(Warning::made_for_another_mill, *first, "1-1", [&] {
      return fmt::format("it fits if a step is {} mm, and here it is {} mm: is it the right profile?", step,
                         profile_.step_mm);
    });
  }
}

// A file of another kind has hardly anything but errors. A job that has lost bytes is correct up to some line.
void Judge::judge_errors(std::uint64_t commands) {
  const std::uint64_t errors = diagnostics_.count(Severity::error);
  if (errors < kManyErrors) return;
  if (paths_before_errors_ >= kSoundPaths) {
    const auto is_error = [](const Diagnostic& one) { return one.severity == Severity::error && one.number != 0; };
    const std::vector<Diagnostic> all = diagnostics_.in_order();
    const auto first = std::ranges::find_if(all, is_error);
    if (first == all.end()) return;
    diagnostics_.warn(Warning::damaged, first->place, "2-3", [&] {
      return fmt::format(
          "sound before line {0}, and from line {0} on {1} errors: is it damaged there, or were bytes lost?",
          first->place.line, errors);
    });
  } else if (errors > commands) {
    diagnostics_.warn(Warning::no_job, {}, "1-2", [&] {
      return fmt::format("more errors than commands, {} and {}: is it a job in RML-1?", errors, commands);
    });
  }
}

void Judge::finish(const Machine& machine, std::uint64_t commands) {
  judge_sizes();
  judge_errors(commands);
  const double z = machine.tool().z;
  if (!last_ || z > 0 || (z == 0 && !machine.tool_lowered())) return;
  diagnostics_.warn(Warning::tool_left_down, *last_, "3-2", [&] {
    return z == 0 ? std::string("the job ends with the tool down, on the surface")
                  : fmt::format("the job ends with the tool down, {:.2f} mm below the surface", -mm(z));
  });
}

}  // namespace axisgate::rml1
