#include "device/shrc203/state/registers.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace axisgate::shrc203 {
namespace {

constexpr Register kAll[] = {Register::m,  Register::a,  Register::k,  Register::e,  Register::j, Register::mp,
                             Register::ap, Register::kp, Register::ep, Register::wt, Register::wi};

constexpr Register kCleared[] = {Register::m, Register::a, Register::k, Register::e};
constexpr Register kLasting[] = {Register::j,  Register::mp, Register::ap, Register::kp,
                                 Register::ep, Register::wt, Register::wi};

// Reports whether the register contains one line or curve of several axes.
bool is_shared(Register reg) {
  return reg == Register::k || reg == Register::e || reg == Register::kp || reg == Register::ep;
}

// Returns the index of an axis among a reply's fields, which are of all three axes or of the controllable ones only.
std::optional<std::size_t> field_of(const Reply& reply, int axis, AxisSet controllable) {
  std::size_t place = 0;
  const auto named = reply.fields.size() == kAxisCount ? kAllAxes : controllable;
  if (!named.has(axis) || reply.fields.size() != static_cast<std::size_t>(named.count())) return {};
  for (const int other : named.list()) {
    if (other == axis) return place;
    ++place;
  }
  return {};
}

// Returns the axes named in the reply to ?:K, ?:KP (first field), ?:E or ?:EP (second field) (manual 22) to 25)).
AxisSet interpolation_axes(const Reply& reply, Register reg) {
  const std::size_t place = reg == Register::e || reg == Register::ep ? 1 : 0;
  if (reply.fields.size() <= place || reply.fields[place].size() != 1) return kAllAxes;
  // A helix also moves axis 3 (manual 74)).
  if (place == 1 && reply.fields[0] >= "3") return kAllAxes;
  return from_command_letter(reply.fields[place][0], kAllAxes).value_or(kAllAxes);
}

}  // namespace

std::span<const Register> Registers::all() { return kAll; }

void Registers::forget() {
  known_ = false;
  ++forgotten_;
}

void Registers::end_reading(Reading reading) {
  set_ = std::move(reading.set_);
  known_ = reading.begun_ == forgotten_;
}

void Registers::Reading::take(Register reg, const Reply& reply, AxisSet controllable) {
  if (is_shared(reg)) {
    if (reply.text != "NS") set_[reg] = interpolation_axes(reply, reg);
    return;
  }
  AxisSet set;
  for (const int axis : controllable.list()) {
    const auto place = field_of(reply, axis, controllable);
    if (!place || reply.fields[*place] != "NS") set.add(axis);
  }
  if (!set.empty()) set_[reg] = set;
}

AxisSet Registers::Reading::set() const {
  AxisSet all;
  for (const auto& [reg, axes] : set_) all = all | axes;
  return all;
}

AxisSet Registers::set_in(Register reg) const {
  const auto found = set_.find(reg);
  return found == set_.end() ? AxisSet() : found->second;
}

bool Registers::any() const { return !clearable().empty() || !lasting().empty(); }

AxisSet Registers::clearable() const {
  AxisSet all;
  for (const Register reg : kCleared) all = all | set_in(reg);
  return all;
}

AxisSet Registers::lasting() const {
  AxisSet all;
  for (const Register reg : kLasting) all = all | set_in(reg);
  return all;
}

void Registers::cleared(AxisSet axes) {
  for (const Register reg : kCleared) {
    const bool whole = axes.contains(set_in(reg));
    const AxisSet rest = whole ? AxisSet() : is_shared(reg) ? set_in(reg) : set_in(reg) - axes;
    if (rest.empty()) {
      set_.erase(reg);
    } else {
      set_[reg] = rest;
    }
  }
}

std::optional<std::int64_t> amount_of(const Reply& reply, int axis, AxisSet controllable) {
  const auto place = field_of(reply, axis, controllable);
  if (!place) return {};
  return parse_integer(reply.fields[*place]);
}

namespace {

// Compares the reply to ?:J, which reports the sign of each axis (manual 31)), with the setter.
Held held_jog(const Reply& reply, const Command& setter, AxisSet controllable) {
  std::vector<std::string> wanted;
  for (const auto& [letter, value] : setter.arguments.values()) {
    if (letter == "m") wanted.push_back(value);
  }
  bool all = true, none = true;
  std::size_t next = 0;
  for (const int axis : setter.axes(controllable).list()) {
    const auto place = field_of(reply, axis, controllable);
    const std::string field = place ? reply.fields[*place] : "";
    all = all && field == wanted[next++];
    none = none && field == "NS";
  }
  return all ? Held::as_set : none ? Held::nothing : Held::other;
}

bool same_amount(std::string_view reported, std::string_view set) {
  const auto one = parse_decimal(reported), other = parse_decimal(set);
  return one && other ? *one == *other : reported == set;
}

// Compares the reply to ?:EP with the setter. The reply has the kind, the axes and the rotation, and then all amounts
// in the order in which they were set (manual 23)).
Held held_curve(const Reply& reply, const Command& setter) {
  if (reply.text == "NS") return Held::nothing;
  std::vector<std::string> wanted = {std::to_string(static_cast<int>(*setter.row->curve))};
  std::string sign;
  for (const auto& [letter, value] : setter.arguments.values()) {
    if (letter == "m") sign = value == "-" ? "-" : "";
    if (letter == "m" || letter == "u") continue;
    if (letter == "spds") break;
    const bool place = letter != "a" && letter != "d" && letter != "n" && letter != "ae";
    wanted.push_back(place ? sign + value : value);
  }
  return std::ranges::equal(reply.fields, wanted, same_amount) ? Held::as_set : Held::other;
}

}  // namespace

Held held(const Reply& reply, const Command& setter, AxisSet controllable) {
  std::vector<std::int64_t> wanted;
  for (const auto& [letter, value] : setter.arguments.values()) {
    if (letter == "y") wanted.push_back(*parse_integer(value));
    if (letter == "m") wanted.push_back(value == "-" ? -1 : 1);
  }
  std::size_t next = 0;
  bool all = true, none = true;
  if (setter.row->reg == Register::j) return held_jog(reply, setter, controllable);
  if (setter.row->reg == Register::ep) return held_curve(reply, setter);
  const bool shared = setter.row->reg == Register::kp;
  if (shared && reply.text == "NS") return Held::nothing;
  const AxisSet axes = setter.axes(controllable);
  if (shared && reply.fields[0] != setter.arguments.first("a")) return Held::other;
  std::size_t place = 1;
  for (const int axis : axes.list()) {
    const auto amount = shared ? (place < reply.fields.size() ? parse_integer(reply.fields[place++]) : std::nullopt)
                               : amount_of(reply, axis, controllable);
    const std::int64_t value = wanted[next] * wanted[next + 1];
    next += 2;
    all = all && amount == value;
    none = none && !amount;
  }
  return all ? Held::as_set : none ? Held::nothing : Held::other;
}

}  // namespace axisgate::shrc203
