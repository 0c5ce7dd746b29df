#include "tests/shot/simulated_unit.h"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

namespace axisgate::shot2 {

std::vector<int> SimulatedUnit::axes_in(std::string_view letter) const {
  const int digit = letter.size() == 1 ? letter[0] - '0' : 0;
  if (digit >= 1 && digit <= static_cast<int>(axes_.size())) return {digit};
  return letter == "A" && axes_.size() > 1 ? std::vector{1, 2} : std::vector<int>();
}

std::string SimulatedUnit::ready() const {
  std::string fields;
  for (const Axis& axis : axes_) fields += axis.arrives ? ",B" : ",R";
  return fields.substr(1);
}

Result<void> SimulatedUnit::Options::set(std::string_view name, std::string_view value) {
  if (name != "speed" || std::atoll(std::string(value).c_str()) < 1) {
    return fail(Reason::invalid_request, "the only option is speed, in pulses/s");
  }
  speed = std::atoll(std::string(value).c_str());
  return {};
}

void SimulatedUnit::link_up(TimePoint now) {
  move_on(now);
  received_.clear();
}

void SimulatedUnit::link_down(TimePoint now, std::string_view) { move_on(now); }
void SimulatedUnit::advance(TimePoint now) { move_on(now); }

void SimulatedUnit::receive(std::string_view bytes, TimePoint now) {
  move_on(now);
  for (const char byte : bytes) {
    if (byte != '\n') {
      if (byte != '\r') received_ += byte;
      continue;
    }
    const std::string line = std::exchange(received_, {});
    line_.write(answer_to(line) + "\r\n");
    before_ = line;
  }
}

std::optional<TimePoint> SimulatedUnit::next_deadline() const {
  std::optional<TimePoint> next;
  for (const Axis& axis : axes_) {
    if (axis.arrives && (!next || *axis.arrives < *next)) next = axis.arrives;
  }
  return next;
}

Result<std::string> SimulatedUnit::operate(std::string_view command, TimePoint now) {
  move_on(now);
  if (command != "positions") return fail(Reason::invalid_request, "say: positions");
  std::string positions;
  for (const Axis& axis : axes_) positions += (positions.empty() ? "" : " ") + std::to_string(axis.place);
  return positions;
}

std::string SimulatedUnit::answer_to(const std::string& line) {
  if (line == "*IDN?") return "SIGMAKOKI,SHOT-" + std::to_string(axes_.size()) + ",4711,V1.00";
  if (line == "?:CMD") return before_;
  if (line == "!:") return ready().find('B') == std::string::npos ? "R" : "B";
  if (line == "!:S") return ready();
  if (line == "Q:SPC") return status();
  if (line.starts_with("AP:")) return set_targets(line.substr(3, 1), std::string_view(line).substr(4));
  if (line.starts_with("G:")) return start(line.substr(2), false);
  if (line.starts_with("HRT:")) return start(line.substr(4), true);
  if (line.starts_with("L:")) return stop(line.substr(2));
  return "NG";
}

// Reads "+P1000-P20".
std::string SimulatedUnit::set_targets(std::string_view letter, std::string_view amounts) {
  const std::vector<int> axes = axes_in(letter);
  std::vector<std::int64_t> targets;
  while (amounts.size() > 2 && amounts[1] == 'P') {
    const std::size_t end = std::min(amounts.find_first_of("+-", 1), amounts.size());
    const std::int64_t way = std::atoll(std::string(amounts.substr(2, end - 2)).c_str());
    targets.push_back(amounts[0] == '-' ? -way : way);
    amounts.remove_prefix(end);
  }
  if (axes.empty() || targets.size() != axes.size() || !amounts.empty()) return "NG";
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axis_of(axes[i]).set = targets[i];
    axis_of(axes[i]).has_set = true;
  }
  return "OK";
}

std::string SimulatedUnit::start(std::string_view letter, bool home) {
  const std::vector<int> axes = axes_in(letter);
  const auto ready = [&](int axis) { return !busy(axis) && (home || axis_of(axis).has_set); };
  if (axes.empty() || !std::ranges::all_of(axes, ready)) return "NG";
  for (const int number : axes) {
    Axis& axis = axis_of(number);
    go(axis, home ? 0 : axis.set);
    if (!home) axis.has_set = false;
  }
  return "OK";
}

std::string SimulatedUnit::stop(std::string_view letter) {
  const std::vector<int> axes = axes_in(letter);
  if (axes.empty()) return "NG";
  for (const int number : axes) {
    axis_of(number).arrives.reset();
    axis_of(number).has_set = false;
  }
  return "OK";
}

std::string SimulatedUnit::status() const {
  std::string amounts, hex;
  for (const Axis& axis : axes_) {
    amounts += (amounts.empty() ? "P" : ",P") + std::to_string(axis.place);
    hex += ",00000001";
  }
  return amounts + hex + "," + ready();
}

void SimulatedUnit::go(Axis& axis, std::int64_t target) {
  axis.from = axis.place;
  axis.target = target;
  axis.since = now_;
  axis.arrives = now_ + Duration(std::abs(target - axis.place) * 1'000'000'000 / options_.speed);
}

// Moves the axes up to `now`. An axis that arrives sends its number.
void SimulatedUnit::move_on(TimePoint now) {
  now_ = now;
  for (int number = 1; number <= static_cast<int>(axes_.size()); ++number) {
    Axis& axis = axis_of(number);
    if (!axis.arrives) continue;
    if (*axis.arrives <= now) {
      axis.place = axis.target;
      axis.arrives.reset();
      line_.write(std::to_string(number) + "\r\n");
      continue;
    }
    const std::int64_t way = (now - axis.since).count() * options_.speed / 1'000'000'000;
    axis.place = axis.from + (axis.target < axis.from ? -way : way);
  }
}

}  // namespace axisgate::shot2
