#include "device/shrc203/planning/transaction_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "device/shrc203/planning/arc_lines.h"
#include "device/shrc203/planning/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

bool is_origin_return(const Command& command) {
  return command.row->meaning == Meaning::mechanical_return || command.row->meaning == Meaning::logical_return;
}

}  // namespace

Result<void> TransactionPrediction::add(const Command& command) {
  if (auto good = add_speeds(command); !good) return good;
  return add_motion(command);
}

Result<void> TransactionPrediction::add_speeds(const Command& command) {
  for (const auto& [axis, minimum, maximum] : speeds_of(command, controllable_)) {
    if (const auto good = envelope_.check_axis(axis); !good) return good;
    // S is the speed of a straight line (manual 83)); F applies to later motions.
    for (const auto& [asked, set] : {std::pair{minimum, &SpeedSetting::minimum}, {maximum, &SpeedSetting::maximum}}) {
      if (!asked) continue;
      const auto speed = envelope_.speed(axis, *asked);
      if (!speed) return tl::unexpected(speed.error());
      if (command.row->sets_speeds == SetsSpeeds::of_motion) speeds_[axis].*set = *speed;
    }
  }
  return {};
}

// Checks that the motion may be set or started, and computes its end.
Result<void> TransactionPrediction::add_motion(const Command& command) {
  const AxisSet axes = command.axes(controllable_);
  if (command.row->meaning == Meaning::clear_setpoints) delete_settings(axes);
  if (command.row->effect == Effect::motion_setting) return add_setting(command);
  if (!command.row->moves()) return {};
  if (is_origin_return(command)) return add_origin_return(command);
  if (command.row->needs.mode == Mode::program) return add_program();
  // Waking up returns the stage to its position (manual 47)), and a wait moves nothing until it ends.
  if (command.row->meaning == Meaning::sleep || waits_of(command).set) return {};
  for (const int axis : axes.list()) {
    if (const auto good = start(axis); !good) return good;
  }
  // Doubtful settings have run by now or were gone: at_ reflects for each axis what is still known.
  if (axes.contains(uncertain_)) uncertain_ = {};
  return {};
}

// The mechanical origin return needs no known position: the axis learns its coordinates from it.
Result<void> TransactionPrediction::add_origin_return(const Command& command) {
  const bool logical = command.row->meaning == Meaning::logical_return;
  for (const int axis : command.axes(controllable_).list()) {
    Result<void> good = envelope_.check_axis(axis);
    if (good && logical) good = envelope_.check_homed(axis);
    if (good && logical) good = envelope_.check_target(axis, 0);
    if (good && logical) good = envelope_.check_speed(axis, speeds_[axis].maximum);
    if (!good) return good;
    at_[static_cast<std::size_t>(axis - 1)] = 0;
    started_.add(axis);
    if (good = start(axis); !good) return good;
  }
  return {};
}

Result<void> TransactionPrediction::go_to(const Positions& place) {
  for (const int axis : controllable_.list()) {
    const auto target = place[static_cast<std::size_t>(axis - 1)];
    if (!target) continue;
    Result<void> good = envelope_.check_axis(axis);
    if (good) good = envelope_.check_homed(axis);
    if (good) good = envelope_.check_target(axis, *target);
    if (good) good = envelope_.check_speed(axis, speeds_[axis].maximum);
    if (!good) return good;
    at_[static_cast<std::size_t>(axis - 1)] = *target;
    started_.add(axis);
  }
  return {};
}

// The targets of a stored program are unknown.
Result<void> TransactionPrediction::add_program() {
  for (const int axis : controllable_.list()) {
    if (envelope_.is_bounded(axis)) {
      return fail_on(axis, Reason::outside_travel,
                     fmt::format("the targets of a stored program are unknown, and {} has a travel envelope",
                                 envelope_.label(axis)),
                     "give its moves as a path, or have the envelope taken out of the configuration");
    }
    at_[static_cast<std::size_t>(axis - 1)].reset();
  }
  return {};
}

// Unclear from the manual: whether both buffers of an axis run, or which one. Each was checked alone, and both together
// are checked here; the position afterwards is then unknown.
Result<void> TransactionPrediction::start(int axis) {
  started_.add(axis);
  auto& at = at_[static_cast<std::size_t>(axis - 1)];
  const auto pending = std::exchange(pending_[axis], {});
  for (const auto& one : pending) {
    // S may have been changed since then.
    const auto paced =
        one.paced_by == 0 ? 0 : std::llround(one.share * static_cast<double>(speeds_[one.paced_by].minimum));
    if (const auto good = envelope_.check_speed(axis, paced); !good) return good;
    if (one.relative) {
      if (const auto good = check_extent(axis, one.extent, one.amount); !good) return good;
    }
    at = one.relative ? *at + one.amount : one.amount;  // an absolute target was checked when it was set
  }
  if (pending.size() > 1 || uncertain_.has(axis)) at.reset();
  return {};
}

// GC: for only some axes of a line or curve may delete all of it or nothing (manual 87)), so the setting stays and is
// doubtful.
void TransactionPrediction::delete_settings(AxisSet axes) {
  for (const Register reg : {Register::m, Register::a, Register::k, Register::e}) {
    const AxisSet set = axes_of(reg);
    const bool whole = reg == Register::k || reg == Register::e;
    if (whole && set.touches(axes) && !axes.contains(set)) {
      uncertain_ = uncertain_ | set;
      continue;
    }
    for (const int axis : axes.list()) drop(axis, reg);
  }
}

Result<void> TransactionPrediction::add_setting(const Command& command) {
  const Register reg = command.row->reg;
  if (reg == Register::e || reg == Register::ep) return add_arc(command);
  const bool relative = reg != Register::a && reg != Register::ap;
  const bool line = reg == Register::k || reg == Register::kp;
  const auto moves = moves_of(command, controllable_);
  const auto plan = moves.empty() ? MovePlan{} : plan_move(moves, relative, at_, envelope_);
  if (!plan) return tl::unexpected(plan.error());
  const bool lasting = reg == Register::mp || reg == Register::ap || reg == Register::kp;
  if (line) {
    if (const auto good = check_scales(plan->set(), envelope_.state()); !good) return good;
    if (const auto good = overwrite(reg, lasting); !good) return good;
  }
  for (const auto& one : plan->axes) {
    if (!one.target) {
      return envelope_.position_unknown(one.axis);
    }
    const SpeedSetting& speed = speeds_[line ? plan->axes.front().axis : one.axis];
    if (const auto good = envelope_.check_speed(one.axis, line ? speed.minimum : speed.maximum); !good) return good;
    Pending pending{reg, relative, lasting, one.amount, {one.amount, one.amount}};
    if (line) pending.paced_by = plan->axes.front().axis;
    if (const auto good = add_pending(one.axis, pending); !good) return good;
  }
  return {};
}

// Checks the whole curve, with the speed S of its lowest axis in every direction (manual 71) to 82)).
Result<void> TransactionPrediction::add_arc(const Command& command) {
  const auto line = arc_of(command, envelope_);
  if (!line) return tl::unexpected(line.error());
  AxisSet axes;
  for (const int axis : line->axes) {
    if (axis != 0) axes.add(axis);
  }
  if (const auto good = check_scales(axes, envelope_.state()); !good) return good;
  const ArcEnd end = end_of(line->arc);
  const std::int64_t speed = speeds_[line->axes[0]].minimum;
  const double slope = std::abs(line->arc.rise) / std::max(1.0, length_of(line->arc));
  const std::pair<std::int64_t, Extent> ways[] = {
      {end.first, line->extent.first}, {end.second, line->extent.second}, {end.third, line->extent.third}};
  const bool lasting = command.row->reg == Register::ep;
  if (const auto good = overwrite(command.row->reg, lasting); !good) return good;
  for (std::size_t i = 0; i < std::size(ways); ++i) {
    const int axis = line->axes[i];
    if (axis == 0) continue;
    if (auto good = envelope_.check_homed(axis); !good) return good;
    const auto part = i < 2 ? speed : std::llround(slope * static_cast<double>(speed));
    if (auto good = envelope_.check_speed(axis, part); !good) return good;
    // Each setting is also checked alone: a prebuffer setting may start without a G, and one setting may replace
    // another.
    if (auto good = check_extent(axis, ways[i].second, ways[i].first); !good) return good;
    Pending one{command.row->reg, true, lasting, ways[i].first, ways[i].second};
    one.paced_by = line->axes[0];
    one.share = i < 2 ? 1 : slope;
    if (auto good = add_pending(axis, one); !good) return good;
  }
  return {};
}

Result<void> TransactionPrediction::check_extent(int axis, const Extent& extent, std::int64_t end) {
  const auto& at = at_[static_cast<std::size_t>(axis - 1)];
  if (!at) {
    return fail_on(axis, Reason::position_unknown,
                   fmt::format("{}: the position after these lines is unknown", envelope_.label(axis)),
                   "send the motion by itself");
  }
  for (const auto reached : {extent.lowest, extent.highest, end}) {
    if (auto good = envelope_.check_target(axis, *at + reached); !good) return good;
  }
  return {};
}

AxisSet TransactionPrediction::axes_of(Register reg) const {
  AxisSet axes;
  for (const auto& [axis, settings] : pending_) {
    if (std::ranges::find(settings, reg, &Pending::reg) != settings.end()) axes.add(axis);
  }
  return axes;
}

void TransactionPrediction::drop(int axis, Register reg) {
  std::erase_if(pending_[axis], [reg](const Pending& one) { return one.reg == reg; });
}

// Removes the previous line or curve from all its axes: each register holds one, whatever its axes (manual 22) to 25)).
Result<void> TransactionPrediction::overwrite(Register reg, bool lasting) {
  for (const int axis : axes_of(reg).list()) {
    if (const auto good = lasting ? check_chain(axis) : Result<void>(); !good) return good;
    drop(axis, reg);
  }
  return {};
}

// The previous prebuffer setting may have chained or not, so the start of the next one would be uncertain.
Result<void> TransactionPrediction::check_chain(int axis) {
  if (!started_.has(axis) || std::ranges::none_of(pending_[axis], &Pending::lasting)) return {};
  return fail_on(axis, Reason::invalid_request,
                 fmt::format("{} has a second prebuffer setting before the next start", envelope_.label(axis)),
                 "start each with G:, or run a path");
}

Result<void> TransactionPrediction::add_pending(int axis, const Pending& one) {
  if (const auto good = one.lasting ? check_chain(axis) : Result<void>(); !good) return good;
  drop(axis, one.reg);
  // A setting of several axes is doubtful on all of them when one of these axes is set again.
  for (const auto& before : pending_[axis]) {
    if (before.paced_by != 0) uncertain_ = uncertain_ | axes_of(before.reg);
  }
  pending_[axis].push_back(one);
  return {};
}

}  // namespace axisgate::shrc203
