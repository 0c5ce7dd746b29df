#include "clients/axisctl/lengths.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

#include "clients/axisctl/failure.h"

namespace axisgate::axisctl {
namespace {

constexpr double kFarthest = 10'000;  // mm; the same limit as in profiles

}  // namespace

jobs::Point lengths(const std::string& text, const char* option) {
  double values[3] = {};
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = true;
  for (int index = 0; index < 3 && good; ++index) {
    const auto [stop, error] = std::from_chars(at, end, values[index]);
    good = error == std::errc() && std::abs(values[index]) <= kFarthest &&
           (index == 2 ? stop == end : stop != end && *stop == ',');
    at = stop + 1;
  }
  if (good) return {values[0], values[1], values[2]};
  throw usage(fmt::format("\"{}\" is not valid for {}", text, option), "use three lengths in mm, e.g. 10,10,5.5");
}

jobs::Stock stock_of(const std::string& text) {
  const jobs::Point p = lengths(text, "--stock");
  if (p.x > 0 && p.y > 0 && p.z > 0) return {p.x, p.y, p.z};
  throw usage("--stock has no size", "use its three lengths in mm, e.g. 80,50,10");
}

}  // namespace axisgate::axisctl
