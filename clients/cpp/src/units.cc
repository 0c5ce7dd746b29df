#include "axisgate/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <regex>

#include "axisgate/errors.h"

namespace axisgate {
namespace {

constexpr std::string_view kUnitNames[] = {"pulses", "nm", "um", "mm", "deg"};

void check_number(const Distance::Number& number) {
  static const std::regex decimal(R"([+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?)");
  if (const double* value = std::get_if<double>(&number)) {
    if (!std::isfinite(*value)) throw InvalidArgument(fmt::format("{} is not an amount: it must be finite", *value));
    return;
  }
  const auto& text = std::get<std::string>(number);
  if (!std::regex_match(text, decimal)) throw InvalidArgument(fmt::format("\"{}\" is not a decimal number", text));
}

}  // namespace

Distance::Distance(Number number, std::string_view unit) : number_(std::move(number)), unit_(unit) {
  check_number(number_);
  if (std::ranges::find(kUnitNames, unit) == std::end(kUnitNames)) {
    throw InvalidArgument(fmt::format("there is no unit \"{}\"; the units are {}", unit, fmt::join(kUnitNames, ", ")));
  }
}

bool Distance::is_negative() const noexcept {
  if (const double* value = std::get_if<double>(&number_)) return *value < 0;
  return std::get_if<std::string>(&number_)->starts_with('-');
}

Distance Distance::operator-() const {
  if (const double* value = std::get_if<double>(&number_)) return {-*value, unit_};
  const auto& text = std::get<std::string>(number_);
  if (text.starts_with('-')) return {text.substr(1), unit_};
  return {"-" + text.substr(text.starts_with('+') ? 1 : 0), unit_};
}

std::string Distance::text() const {
  return std::visit([&](const auto& number) { return fmt::format("{} {}", number, unit_); }, number_);
}

}  // namespace axisgate
