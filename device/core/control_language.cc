#include "device/core/control_language.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

#include "device/core/escape.h"

namespace axisgate {
namespace {

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

bool same_word(std::string_view one, std::string_view other) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [&](char a, char b) { return lower(a) == lower(b); });
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
  // Written so that NaN is outside, too.
  const bool inside = value >= static_cast<double>(number.minimum) && value <= static_cast<double>(number.maximum);
  return inside ? std::optional(value) : std::nullopt;
}

std::string quoted_word(std::string_view word) { return "'" + escaped(word) + "'"; }

}  // namespace

std::vector<std::string_view> words_of(std::string_view text) { return split(text, " \t"); }

const NumberField* ControlLanguage::number_called(std::string_view name) const {
  const auto found =
      std::find_if(numbers_.begin(), numbers_.end(), [&](const NumberField& n) { return n.name == name; });
  return found == numbers_.end() ? nullptr : &*found;
}

const ControlUsage* ControlLanguage::command_called(std::string_view name) const {
  const auto found = std::find_if(commands_.begin(), commands_.end(), [&](const ControlUsage& command) {
    return same_word(words_of(command.usage).front(), name);
  });
  return found == commands_.end() ? nullptr : &*found;
}

tl::unexpected<Problem> ControlLanguage::refuse(std::string what) const {
  std::string names;
  for (const ControlUsage& command : commands_) {
    names += (names.empty() ? "" : ", ") + std::string(words_of(command.usage).front());
  }
  return fail(Reason::invalid_request, std::move(what), "say one of: " + names);
}

std::string ControlLanguage::with_ranges(std::string_view usage) const {
  std::string ranges;
  for (const std::string_view place : words_of(usage)) {
    const NumberField* number = number_called(without_brackets(place));
    if (number == nullptr) continue;
    ranges += (ranges.empty() ? " (" : ", ") + std::string(number->name) + " " + std::to_string(number->minimum) +
              " to " + std::to_string(number->maximum);
  }
  return std::string(usage) + (ranges.empty() ? "" : ranges + ")");
}

Result<std::string> ControlLanguage::help(const std::vector<Argument>& arguments) const {
  if (!arguments.empty()) {
    const ControlUsage* command = command_called(arguments.front().word);
    if (command == nullptr) return refuse("there is no command " + quoted_word(arguments.front().word));
    return with_ranges(command->usage) + ": " + std::string(command->meaning);
  }
  std::string usages;
  for (const ControlUsage& command : commands_) usages += (usages.empty() ? "" : "; ") + std::string(command.usage);
  return usages;
}

// Reports whether `word` is allowed for `place` of the usage; adds its value to `arguments`.
bool ControlLanguage::take_word(std::string_view word, std::string_view place, std::vector<Argument>& arguments) const {
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

Result<std::vector<Argument>> ControlLanguage::read_arguments(const std::vector<std::string_view>& words,
                                                              std::string_view usage) const {
  const auto refused = [&](std::string what) {
    return fail(Reason::invalid_request, std::move(what), "say: " + with_ranges(usage));
  };
  std::vector<Argument> arguments;
  const auto places = words_of(usage);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string_view place = without_brackets(places[i]);
    if (i >= words.size()) {
      if (may_be_left_out(places[i])) break;
      return refused(std::string(place) + " is missing");
    }
    if (!take_word(words[i], place, arguments)) {
      return refused(quoted_word(words[i]) + " cannot be used as " + std::string(place));
    }
  }
  if (words.size() > places.size()) return refused(quoted_word(words[places.size()]) + " is too much");
  return arguments;
}

Result<ControlLanguage::Call> ControlLanguage::read(std::string_view line) const {
  if (line.size() > kControlLineMax) {
    return refuse("the line is longer than " + std::to_string(kControlLineMax) + " characters");
  }
  const auto words = words_of(line);
  if (words.empty()) return refuse("the line is empty");
  const ControlUsage* command = command_called(words.front());
  if (command == nullptr) return refuse("there is no command " + quoted_word(words.front()));
  auto arguments = read_arguments(words, command->usage);
  if (!arguments) return tl::unexpected(std::move(arguments.error()));
  return Call{static_cast<std::size_t>(command - commands_.data()), std::move(*arguments)};
}

std::string control_reply(const Result<std::string>& done) {
  if (!done) return "error: " + done.error().message + "; " + done.error().hint;
  return done->empty() ? "ok" : "ok " + *done;
}

}  // namespace axisgate
