#include "device/shrc203/simulator/control_usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

#include "device/core/escape.h"
#include "device/shrc203/simulator/axis_set.h"

namespace axisgate::shrc203::simulator {
namespace {

struct NumberField {
  std::string_view name;
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  bool fractions = false;
};

constexpr std::array kNumbers = {
    NumberField{"AXIS", 1, kAxes},
    NumberField{"NUMBER", 0, 63},  // IN1 to IN6 as bits (manual 95) I:)
    NumberField{"MILLISECONDS", 0, 60'000},
    NumberField{"SECONDS", 0, 3600, true},
};

constexpr std::string_view kAnyWord = "COMMAND";

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto begin = text.find_first_not_of(separators);
    if (begin == std::string_view::npos) return parts;
    text.remove_prefix(begin);
    parts.push_back(text.substr(0, text.find_first_of(separators)));
    text.remove_prefix(parts.back().size());
  }
}

const NumberField* number_called(std::string_view name) {
  const auto found =
      std::find_if(kNumbers.begin(), kNumbers.end(), [&](const NumberField& n) { return n.name == name; });
  return found == kNumbers.end() ? nullptr : &*found;
}

bool may_be_left_out(std::string_view place) { return place.starts_with('['); }

std::string_view without_brackets(std::string_view place) {
  return may_be_left_out(place) ? place.substr(1, place.size() - 2) : place;
}

std::optional<double> read_number(std::string_view word, const NumberField& number) {
  const char* const end = word.data() + word.size();
  double value = 0;
  std::int64_t whole = 0;
  const auto read = number.fractions ? std::from_chars(word.data(), end, value, std::chars_format::fixed)
                                     : std::from_chars(word.data(), end, whole);
  if (read.ec != std::errc{} || read.ptr != end) return std::nullopt;
  if (!number.fractions) value = static_cast<double>(whole);
  // Written so that what is not a number is outside, too.
  const bool inside = value >= static_cast<double>(number.minimum) && value <= static_cast<double>(number.maximum);
  return inside ? std::optional(value) : std::nullopt;
}

// Whether `word` may stand where the usage has `place`; what it stands for goes to `arguments`.
bool take_word(std::string_view word, std::string_view place, std::vector<Argument>& arguments) {
  if (const NumberField* number = number_called(place)) {
    const auto value = read_number(word, *number);
    if (value) arguments.push_back({word, *value});
    return value.has_value();
  }
  if (place == kAnyWord) {
    arguments.push_back({word});
    return true;
  }
  const auto choices = split(place, "|");
  const auto chosen =
      std::find_if(choices.begin(), choices.end(), [&](std::string_view choice) { return same_word(word, choice); });
  if (chosen == choices.end()) return false;
  if (choices.size() > 1) arguments.push_back({*chosen, static_cast<double>(chosen - choices.begin())});
  return true;
}

}  // namespace

std::vector<std::string_view> words_of(std::string_view text) { return split(text, " \t"); }

bool same_word(std::string_view one, std::string_view other) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [&](char a, char b) { return lower(a) == lower(b); });
}

std::string with_ranges(std::string_view usage) {
  std::string ranges;
  for (const std::string_view place : words_of(usage)) {
    const NumberField* number = number_called(without_brackets(place));
    if (number == nullptr) continue;
    ranges +=
        fmt::format("{}{} {} to {}", ranges.empty() ? " (" : ", ", number->name, number->minimum, number->maximum);
  }
  return fmt::format("{}{}", usage, ranges.empty() ? "" : ranges + ")");
}

Result<std::vector<Argument>> read_arguments(const std::vector<std::string_view>& words, std::string_view usage) {
  const auto refuse = [usage](std::string what) {
    return fail(Reason::invalid_request, std::move(what), "say: " + with_ranges(usage));
  };
  std::vector<Argument> arguments;
  const auto places = words_of(usage);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string_view place = without_brackets(places[i]);
    if (i >= words.size()) {
      if (may_be_left_out(places[i])) break;
      return refuse(fmt::format("{} is missing", place));
    }
    if (!take_word(words[i], place, arguments)) {
      return refuse(fmt::format("'{}' cannot stand for {}", escaped(words[i]), place));
    }
  }
  if (words.size() > places.size()) return refuse(fmt::format("'{}' is too much", escaped(words[places.size()])));
  return arguments;
}

}  // namespace axisgate::shrc203::simulator
