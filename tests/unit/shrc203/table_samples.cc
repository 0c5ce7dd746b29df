#include "tests/unit/shrc203/table_samples.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "device/shot/command/axes.h"

namespace axisgate::shrc203 {
namespace {

// Returns the offset at which the group at the beginning of `format` ends.
std::size_t closing(std::string_view format, char open, char close) {
  int depth = 0;
  for (std::size_t i = 0; i < format.size(); ++i) {
    depth += format[i] == open ? 1 : format[i] == close ? -1 : 0;
    if (depth == 0) return i;
  }
  ADD_FAILURE() << "unbalanced format " << format;
  return format.size() - 1;
}

}  // namespace

std::vector<std::string> words(std::string_view text) {
  std::vector<std::string> all;
  while (!text.empty()) {
    const auto end = std::min(text.find(' '), text.size());
    all.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return all;
}

Sample Sample::with(std::size_t which, std::string value) const {
  Sample other = *this;
  other.line.replace(places[which], values[which].second.size(), value);
  other.values[which].second = std::move(value);
  return other;
}

Arguments Sample::arguments() const {
  Arguments arguments;
  for (const auto& [letter, value] : values) arguments.add(letter, value);
  return arguments;
}

Sample SampleGenerator::sample() {
  write(row_.format);
  return std::move(sample_);
}

void SampleGenerator::write(std::string_view format) {
  while (!format.empty()) {
    std::size_t end = 0;
    if (format.front() == '<') {
      end = format.find('>');
      add(format.substr(1, end - 1));
    } else if (format.front() == '[') {
      end = closing(format, '[', ']');
      if (below(2) == 0) write(format.substr(1, end - 1));
    } else if (format.front() == '{') {
      end = closing(format, '{', '}');
      repeat(format.substr(1, end - 1));
    } else {
      sample_.line += format.front();
    }
    format.remove_prefix(end + 1);
  }
}

void SampleGenerator::repeat(std::string_view inner) {
  const auto bar = std::min(inner.find('|'), inner.size());
  const auto separator = inner.substr(std::min(bar + 1, inner.size()));
  for (std::size_t i = 0; i < repeats_; ++i) {
    if (i > 0) sample_.line += separator;
    write(inner.substr(0, bar));
  }
}

void SampleGenerator::add(std::string_view letter) {
  const auto parameter = std::ranges::find(row_.parameters, letter, &Parameter::letter);
  if (parameter == row_.parameters.end()) {
    ADD_FAILURE() << row_.name << ": <" << letter << "> of the format is no parameter";
    return;
  }
  std::string value = draw(*parameter);
  if (letter == "u") pulses_ = value == "P" || value == "F";
  // W means all axes of the controller, of which there are one to three; all repeated parts of a line agree on the
  // number.
  if (letter == "a" && parameter->kind == Parameter::Kind::choice) {
    const auto axes = from_command_letter(value.front(), kAllAxes);
    repeats_ = value == "W" ? 1 + below(3) : static_cast<std::size_t>(axes.value_or(AxisSet::of(1)).count());
  }
  sample_.places.push_back(sample_.line.size());
  sample_.line += value;
  sample_.values.emplace_back(letter, std::move(value));
}

std::string SampleGenerator::draw(const Parameter& parameter) {
  switch (parameter.kind) {
    case Parameter::Kind::choice: {
      const std::vector<std::string> choices = words(parameter.choices);
      return choices[below(choices.size())];
    }
    case Parameter::Kind::integer:
      return std::to_string(between(parameter.minimum, parameter.maximum));
    case Parameter::Kind::decimal:
      return decimal(parameter);
    case Parameter::Kind::angle:
      return below(2) == 0 ? std::to_string(between(1, parameter.maximum))
                           : fraction(between(0, parameter.maximum - 1));
    case Parameter::Kind::text:
      return text();
  }
  return {};
}

// Returns a value of S, F or a displacement: a whole number of pulses, or any decimal in other units. F is never below
// its S.
std::string SampleGenerator::decimal(const Parameter& parameter) {
  std::int64_t minimum = parameter.minimum;
  if (parameter.letter == "spdf") minimum = minimum_speed_ + 1;
  const std::int64_t most = parameter.letter == "spds" ? parameter.maximum - 1 : parameter.maximum;
  const std::int64_t whole = between(minimum, most);
  if (parameter.letter == "spds") minimum_speed_ = whole;
  return pulses_ || below(2) == 0 ? std::to_string(whole) : fraction(whole);
}

// Returns the ends of the range, where mistakes are likely, more often than values in between.
std::int64_t SampleGenerator::between(std::int64_t minimum, std::int64_t maximum) {
  switch (below(8)) {
    case 0:
      return minimum;
    case 1:
      return maximum;
    default:
      return minimum + static_cast<std::int64_t>(below(static_cast<std::uint64_t>(maximum - minimum + 1)));
  }
}

// Returns a decimal with at most 15 characters, whose last digit is not 0.
std::string SampleGenerator::fraction(std::int64_t whole) {
  std::string digits;
  for (std::uint64_t left = below(4); left > 0; --left) digits += static_cast<char>('0' + below(10));
  return fmt::format("{}.{}{}", whole, digits, 1 + below(9));
}

// Returns numbers and letters, separated by commas.
std::string SampleGenerator::text() {
  std::string out = std::to_string(below(1000));
  for (std::uint64_t left = below(10); left > 0; --left) {
    out += below(4) == 0 ? fmt::format(",{}", static_cast<char>('A' + below(26))) : fmt::format(",{}", below(100'000));
  }
  return out;
}

}  // namespace axisgate::shrc203
