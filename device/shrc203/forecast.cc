#include "device/shrc203/forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/shrc203/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

bool is_origin_return(const Command& command) {
  const auto& name = command.row->name;
  return name == "H:" || name == "HRT:" || name == "Z:" || name == "ZRT:";
}

}  // namespace

Result<void> Forecast::add(const Command& command) {
  if (auto good = add_speeds(command); !good) return good;
  return add_motion(command);
}

Result<void> Forecast::add_speeds(const Command& command) {
  for (const auto& [axis, minimum, maximum] : speeds_of(command, controllable_)) {
    if (const auto good = envelope_.check_axis(axis); !good) return good;
    const auto lowest = envelope_.speed(axis, minimum);
    if (!lowest) return tl::unexpected(lowest.error());
    // Of a straight line S is what it runs at (manual 83)); F is for what comes after.
    const auto highest = envelope_.speed(axis, maximum);
    if (!highest) return tl::unexpected(highest.error());
    speeds_[axis].minimum = *lowest;
    speeds_[axis].maximum = *highest;
  }
  return {};
}

// That it may be set or started, and where it ends.
Result<void> Forecast::add_motion(const Command& command) {
  const AxisSet axes = command.axes(controllable_);
  if (command.row->name == "GC:") {
    for (const int axis : axes.list()) std::erase_if(pending_[axis], [](const auto& p) { return !p.lasting; });
  }
  if (command.row->effect == Effect::motion_setting) return add_setting(command);
  if (!command.row->moves()) return {};
  if (is_origin_return(command)) return add_origin_return(command);
  if (command.row->needs.mode == Mode::program) return add_program();
  // A sleeper comes back to its place (manual 47)), and a wait moves nothing before it ends.
  if (command.row->name == "SLEEP:" || waits_of(command).set) return {};
  for (const int axis : axes.list()) {
    if (const auto good = start(axis); !good) return good;
  }
  return {};
}

// The mechanical origin return is how the axis comes to know its places.
Result<void> Forecast::add_origin_return(const Command& command) {
  const bool logical = command.row->name.starts_with("Z");
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

// Where a stored program leads is not known.
Result<void> Forecast::add_program() {
  for (const int axis : controllable_.list()) {
    if (envelope_.is_bounded(axis)) {
      return fail_on(
          axis, Reason::outside_travel,
          fmt::format("where a stored program leads is not known, and {} has a travel envelope", envelope_.label(axis)),
          "give its moves as a path, or have the envelope taken out of the configuration");
    }
    at_[static_cast<std::size_t>(axis - 1)].reset();
  }
  return {};
}

// Whether both buffers of one axis run, or which, is an open question: each alone was checked, and both together.
Result<void> Forecast::start(int axis) {
  started_.add(axis);
  auto& at = at_[static_cast<std::size_t>(axis - 1)];
  for (const auto& pending : std::exchange(pending_[axis], {})) {
    if (pending.relative && !at) {
      return fail_on(axis, Reason::position_unknown,
                     fmt::format("where {} would be is not known", envelope_.label(axis)), "send the motion by itself");
    }
    at = pending.relative ? *at + pending.amount : pending.amount;
    if (const auto good = envelope_.check_target(axis, *at); !good) return good;
  }
  return {};
}

Result<void> Forecast::add_setting(const Command& command) {
  const Register reg = command.row->reg;
  const bool relative = reg != Register::a && reg != Register::ap;
  const bool line = reg == Register::k || reg == Register::kp;
  const auto moves = moves_of(command, controllable_);
  const auto plan = moves.empty() ? MovePlan{} : plan_move(moves, relative, at_, envelope_);
  if (!plan) return tl::unexpected(plan.error());
  for (const auto& one : plan->axes) {
    if (!one.target) {
      return fail_on(one.axis, Reason::position_unknown,
                     fmt::format("where {} stands is not known", envelope_.label(one.axis)),
                     "wait until the device is up");
    }
    const SpeedSetting& speed = speeds_[line ? plan->axes.front().axis : one.axis];
    if (const auto good = envelope_.check_speed(one.axis, line ? speed.minimum : speed.maximum); !good) return good;
    auto& pending = pending_[one.axis];
    const bool lasting = reg == Register::mp || reg == Register::ap || reg == Register::kp;
    // The one before may have chained, or not: where this one would start from is not certain.
    const bool chains = started_.has(one.axis) && std::ranges::any_of(pending, &Pending::lasting);
    if (lasting && chains) {
      return fail_on(one.axis, Reason::invalid_request,
                     fmt::format("{} has a second prebuffer setting before the next start", envelope_.label(one.axis)),
                     "start each with G:, or run a path");
    }
    std::erase_if(pending, [reg](const auto& before) { return before.reg == reg; });
    pending.push_back({reg, relative, lasting, one.amount});
  }
  return {};
}

}  // namespace axisgate::shrc203
