#include "device/rml1/check/unit_clues.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace axisgate::rml1 {
namespace {

// The figures of this file are assumptions about the programs that write jobs, and about what people mill.

// Share of jobs whose deepest cut is about `mm` deep. The spread is a factor, as a natural logarithm.
struct UsualDepth {
  double mm, spread, share;
};
constexpr std::array kDepths{
    UsualDepth{0.11, 0.4, 0.40},  // traces of a board
    UsualDepth{1.7, 0.15, 0.30},  // through a board
    UsualDepth{0.5, 1.0, 0.20},   // signs and pockets
    UsualDepth{5, 0.9, 0.15},     // reliefs
};
constexpr double kAnyDepth = 1e-4;

struct UsualLift {
  double mm, share;
};
constexpr std::array kLifts{UsualLift{0.5, 0.04}, UsualLift{1, 0.25},   UsualLift{1.27, 0.01}, UsualLift{1.5, 0.05},
                            UsualLift{2, 0.30},   UsualLift{2.5, 0.04}, UsualLift{2.54, 0.02}, UsualLift{3, 0.10},
                            UsualLift{4, 0.03},   UsualLift{5, 0.10},   UsualLift{10, 0.04},   UsualLift{12.5, 0.01}};

constexpr double kAnyLift = 0.02;

bool alike(double a, double b) { return std::abs(a - b) < 1e-6; }

double share_of(const UsualDepth& usual, double mm) {
  const double off = std::log(mm / usual.mm) / usual.spread;
  return usual.share * std::exp(-off * off / 2) / usual.spread;
}

double depth_share(double mm, bool relief) {
  if (relief) return kAnyDepth + share_of(kDepths.back(), mm);
  double share = kAnyDepth;
  for (const UsualDepth& one : kDepths) share += share_of(one, mm);
  return share;
}

// Returns the share of jobs with this lift. People choose round figures; some choose them in steps.
double lift_share(double mm) {
  const auto found = std::ranges::find_if(kLifts, [mm](const UsualLift& one) { return alike(one.mm, mm); });
  if (found != kLifts.end()) return kAnyLift + found->share;
  const auto is_multiple = [mm](double of) { return alike(mm / of, std::round(mm / of)); };
  return kAnyLift + (is_multiple(1) ? 0.01 : is_multiple(0.5) ? 0.006 : 0.002);
}

}  // namespace

void UnitClues::deep(double steps) {
  deepest_ = std::max(deepest_, steps);
  if (depths_.size() <= kLevelsOfARelief) depths_.insert(steps);
}

void UnitClues::lifted(double steps) { lift_ = lift_ ? std::min(*lift_, steps) : steps; }

double UnitClues::likelihood(double step_mm) const {
  const bool relief = depths_.size() > kLevelsOfARelief;
  return (deepest_ > 0 ? std::log(depth_share(deepest_ * step_mm, relief)) : 0) +
         (lift_ ? std::log(lift_share(*lift_ * step_mm)) : 0);
}

double UnitClues::odds(double step_mm, double other_mm) const { return likelihood(step_mm) - likelihood(other_mm); }

}  // namespace axisgate::rml1
