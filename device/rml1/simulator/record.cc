#include "device/rml1/simulator/record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <utility>

#include "device/rml1/simulator/seconds.h"

namespace axisgate::rml1::simulator {
namespace {

std::string axes_text(const std::vector<AxisNumber>& axes) {
  std::string text;
  for (const AxisNumber& axis : axes) {
    text += fmt::format("{}\"{}\":{}", text.empty() ? "" : ",", axis.axis, axis.value);
  }
  return text;
}

// Rounds to a millionth of a step: smaller amounts are the rounding of a computed point, not a displacement.
double rounded(double steps) { return std::round(steps * 1e6) / 1e6 + 0.0; }

std::string point_text(const Position& p) {
  return fmt::format("[{},{},{}]", rounded(p.x), rounded(p.y), rounded(p.h));
}

}  // namespace

template <class... Values>
void Record::line(std::string_view format, const Values&... values) {
  if (!write_) return;
  write_(fmt::format("{{\"t\":{:.6f},{}}}", in_seconds(now_), fmt::vformat(format, fmt::make_format_args(values...))));
}

void Record::at(TimePoint now) {
  if (!std::exchange(begun_, true)) begin_ = now;
  now_ = now - begin_;
}

void Record::command(const Order& order, std::size_t buffered) {
  const std::string axes = order.axes.empty() ? "" : fmt::format(",\"axes\":{{{}}}", axes_text(order.axes));
  line("\"command\":\"{}\",\"numbers\":[{}]{},\"buffered\":{}", order.command->name, fmt::join(order.numbers, ","),
       axes, buffered);
}

void Record::path(TimePoint began, const Position& from, const Position& to) {
  line("\"began\":{:.6f},\"path\":[{},{}]", in_seconds(began - begin_), point_text(from), point_text(to));
}

void Record::wait(std::string_view what, Duration time) {
  line("\"wait\":\"{}\",\"seconds\":{}", what, in_seconds(time));
}

void Record::turn(double degrees) { line("\"turn\":{}", degrees); }

void Record::spindle(double rpm) { line("\"spindle\":{}", rpm); }

void Record::error(int number) { line("\"error\":{}", number); }

void Record::panel(std::string_view what) { line("\"panel\":\"{}\"", what); }

void Record::discarded(std::string_view by, std::size_t bytes) { line("\"discarded\":{},\"by\":\"{}\"", bytes, by); }

}  // namespace axisgate::rml1::simulator
