#include "device/rml1/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace axisgate::rml1 {
namespace {

// The two lengths of a step that there are among these machines.
constexpr double kSteps[] = {0.01, 0.025};
constexpr double kHalfStep = 0.5;

bool same(double a, double b) { return std::abs(a - b) < 1e-9; }

}  // namespace

template <class Text>
void Judge::warn_once(Cause cause, const Place& place, std::string_view section, Text&& text) {
  if (told_.insert(cause).second) diagnostics_.add(0, Severity::warning, place, section, text);
}

void Judge::moved(const Move& move) {
  last_ = move.place;
  if (!move.below_surface()) {
    const bool travels = move.row->deed == Deed::plot && !move.lowered && move.from.z <= 0 && move.from.z == move.to.z;
    if (travels) {
      warn_once(Cause::on_the_surface, move.place, "3-2",
                [] { return "travels at Z2 = 0: with the tool on the surface of the workpiece"; });
    }
    return;
  }
  if (!move.turning) {
    warn_once(Cause::no_spindle, move.place, "5-2", [] {
      return "goes below the surface while the spindle stands still: !MC0 forbids it, and !MC1 permits it again";
    });
  }
  if (stock_) judge_stock(move);
}

void Judge::judge_stock(const Move& move) {
  const double x = profile_.steps(stock_->x) + kHalfStep, y = profile_.steps(stock_->y) + kHalfStep;
  const double bottom = -profile_.steps(stock_->z) - kHalfStep;
  for (const Point& p : {move.from, move.to}) {
    if (p.z >= 0) continue;
    if (p.x < -kHalfStep || p.y < -kHalfStep || p.x > x || p.y > y) {
      warn_once(Cause::outside_stock, move.place, "5-1", [&] {
        return fmt::format("below the surface outside of the stock, at X {:.2f} mm, Y {:.2f} mm, {:.2f} mm deep",
                           mm(p.x), mm(p.y), -mm(p.z));
      });
    }
    if (p.z < bottom) {
      warn_once(Cause::too_deep, move.place, "5-1", [&] {
        return fmt::format("{:.2f} mm deep, and the stock is {:.2f} mm thick: it cuts into what lies below", -mm(p.z),
                           stock_->z);
      });
    }
  }
}

void Judge::commanded(const Point& target, const Box& box, const Instruction& by) {
  const Bounds before = asked_;
  asked_.take(target);
  if (asked_.x.size() > before.x.size()) widest_x_ = by.place;
  if (asked_.y.size() > before.y.size()) widest_y_ = by.place;
  if (asked_.z.lowest < before.z.lowest) deepest_ = by.place;
  if (!origin_known_) return;
  if (!box.over(target)) {
    const bool cuts = target.z < 0;
    const auto text = [&] {
      return fmt::format("leaves the work area to X {:.2f} mm, Y {:.2f} mm: {}", mm(target.x), mm(target.y),
                         cuts ? "what lies outside is not cut" : "it is not driven there");
    };
    if (cuts) warn_once(Cause::cuts_outside_area, by.place, "5-1", text);
    if (!cuts && told_.insert(Cause::travels_outside_area).second) {
      diagnostics_.add(0, Severity::note, by.place, "5-1", text);
    }
  } else if (target.z < box.lowest.z) {
    warn_once(Cause::below_bottom, by.place, "5-1", [&] {
      return fmt::format("{:.2f} mm below the surface, and the machine reaches {:.2f} mm: it cuts less deep",
                         -mm(target.z), -mm(box.lowest.z));
    });
  }
}

// Nothing in a job tells its unit; a lift by a whole travel does.
void Judge::lifted(double steps, const Instruction& by) {
  const auto travel_of = [steps](double z_mm, double step) { return std::abs(z_mm / step - steps) <= kHalfStep; };
  if (told_.contains(Cause::lift) || travel_of(profile_.z_mm, profile_.step_mm)) return;
  for (const KnownMachine& other : others_) {
    if (same(other.step_mm, profile_.step_mm) || !travel_of(other.z_mm, other.step_mm)) continue;
    warn_once(Cause::lift, by.place, "1-1", [&] {
      return fmt::format(
          "a lift of {:g} steps is the whole travel of the {}, whose step is {} mm; here it is {} mm: is it the right "
          "profile?",
          steps, other.name, other.step_mm, profile_.step_mm);
    });
    return;
  }
}

void Judge::judge_size(const Reach& reach, double area_mm, std::string_view axis, const Place& place) {
  const double size = reach.size();
  if (mm(size) <= area_mm + profile_.step_mm / 2) return;
  diagnostics_.error(0, place, "5-1", [&] {
    return fmt::format("larger than the machine: {:.2f} mm in {}, where the {} has {:.2f} mm", mm(size), axis,
                       profile_.name, area_mm);
  });
  for (const double step : kSteps) {
    if (same(step, profile_.step_mm) || size * step > area_mm) continue;
    diagnostics_.add(0, Severity::warning, place, "1-1", [&] {
      return fmt::format("it fits if a step is {} mm, and here it is {} mm: is it the right profile?", step,
                         profile_.step_mm);
    });
  }
}

void Judge::finish(const Machine& machine) {
  judge_size(asked_.x, profile_.x_mm, "X", widest_x_);
  judge_size(asked_.y, profile_.y_mm, "Y", widest_y_);
  // What lies above the top is clipped (3-2 PU), and no size.
  Reach depth;
  depth.take(0);
  depth.take(std::min(0.0, asked_.z.lowest));
  judge_size(depth, profile_.z_mm, "Z", deepest_);
  const double z = machine.tool().z;
  if (!last_ || z > 0 || (z == 0 && !machine.tool_lowered())) return;
  diagnostics_.add(0, Severity::warning, *last_, "3-2",
                   [&] { return fmt::format("the job ends with the tool down, {:.2f} mm below the surface", -mm(z)); });
}

}  // namespace axisgate::rml1
