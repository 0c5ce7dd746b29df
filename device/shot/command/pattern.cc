#include "device/shot/command/pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "device/core/quantity.h"

namespace axisgate::shot {
namespace {

constexpr int kDecimalDigitsMax = 15;
__extension__ typedef __int128 Wide;  // for two 15-digit decimals scaled to the same number of decimal places

const Parameter* find_parameter(const CommandRow& row, std::string_view letter) {
  const auto found = std::ranges::find(row.parameters, letter, &Parameter::letter);
  return found == row.parameters.end() ? nullptr : &*found;
}

bool is_choice(std::string_view choices, std::string_view value) {
  while (!choices.empty()) {
    const auto end = choices.find(' ');
    if (choices.substr(0, end) == value) return true;
    choices = end == std::string_view::npos ? std::string_view() : choices.substr(end + 1);
  }
  return false;
}

// Returns the length of the longest word that begins `text`.
std::size_t choice_length(std::string_view choices, std::string_view text) {
  std::size_t longest = 0;
  while (!choices.empty()) {
    const auto end = std::min(choices.find(' '), choices.size());
    if (text.starts_with(choices.substr(0, end))) longest = std::max(longest, end);
    choices = choices.substr(std::min(end + 1, choices.size()));
  }
  return longest;
}

// Returns the number at the start of `text` if the choices are numbers, even if it is not one of them. The error then
// names the number instead of another form.
std::string_view number_chosen(std::string_view choices, std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto first = std::ranges::find_if(choices, is_digit);
  if (first == choices.end()) return {};
  const bool of_one_digit = std::ranges::adjacent_find(choices, [&](char one, char next) {
                              return is_digit(one) && is_digit(next);
                            }) == choices.end();
  const auto end = std::ranges::find_if_not(text, is_digit);
  const auto length = static_cast<std::size_t>(end - text.begin());
  return text.substr(0, of_one_digit ? std::min<std::size_t>(length, 1) : length);
}

// A bracketed part of a format, and the text after it.
struct Group {
  std::string_view inner, rest;
};

Group split_group(std::string_view format, char open, char close) {
  int depth = 0;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] == open) ++depth;
    if (format[i] == close && --depth == 0) return {format.substr(1, i - 1), format.substr(i + 1)};
  }
  std::abort();  // the table is wrong
}

struct Repeated {
  std::string_view once, separator;
};

Repeated split_repeated(std::string_view inner) {
  const auto bar = inner.find('|');
  if (bar == std::string_view::npos) return {inner, {}};
  return {inner.substr(0, bar), inner.substr(bar + 1)};
}

std::string_view first_letter(std::string_view format) {
  const auto begin = format.find('<');
  return format.substr(begin + 1, format.find('>', begin) - begin - 1);
}

tl::unexpected<Problem> out_of_range(const CommandRow& row, const Parameter& parameter, std::string_view value) {
  std::string allowed = fmt::format("{} to {} {}", parameter.minimum, parameter.maximum, parameter.unit);
  if (parameter.kind == Parameter::Kind::choice) allowed = fmt::format("one of {}", parameter.choices);
  if (parameter.kind == Parameter::Kind::angle)
    allowed = fmt::format("more than 0, up to {} degrees", parameter.maximum);
  return fail(
      Reason::out_of_range,
      fmt::format("{} takes {} as {} ({}), not \"{}\"", row.name, allowed, parameter.letter, parameter.meaning, value),
      "see `ListCommands`");
}

// Compares exactly, for any number of decimal places.
bool exceeds(Decimal one, Decimal other) {
  const auto scaled = [places = std::max(one.decimals, other.decimals)](Decimal decimal) {
    Wide digits = decimal.digits;
    for (int i = decimal.decimals; i < places; ++i) digits *= 10;
    return digits;
  };
  return scaled(one) > scaled(other);
}

Result<void> check_value(const CommandRow& row, const Parameter& parameter, std::string_view value) {
  switch (parameter.kind) {
    case Parameter::Kind::choice:
      if (!is_choice(parameter.choices, value)) return out_of_range(row, parameter, value);
      return {};
    case Parameter::Kind::integer: {
      const auto number = parse_decimal(value);
      if (!number || number->decimals != 0 || number->digits < parameter.minimum ||
          number->digits > parameter.maximum) {
        return out_of_range(row, parameter, value);
      }
      return {};
    }
    case Parameter::Kind::decimal: {
      const auto number = value.size() <= kDecimalDigitsMax ? parse_decimal(value) : fail(Reason::out_of_range, "");
      if (!number || value.front() == '-' || value.front() == '+') return out_of_range(row, parameter, value);
      return {};
    }
    case Parameter::Kind::angle: {
      const auto degrees = value.size() <= kDecimalDigitsMax ? parse_decimal(value) : fail(Reason::out_of_range, "");
      const Decimal most{parameter.maximum, 0};
      if (!degrees || degrees->digits <= 0 || exceeds(*degrees, most)) return out_of_range(row, parameter, value);
      return {};
    }
    case Parameter::Kind::text:
      return {};
  }
  std::abort();
}

// P for a distance, F for a speed (manual 67), 93)).
bool counts_pulses(std::string_view unit) { return unit == "P" || unit == "F"; }

// Checks the ranges of decimals, which apply only to values in pulses, and that S does not exceed F in any unit.
Result<void> check_amounts(const CommandRow& row, const Arguments& arguments) {
  bool in_pulses = true, all_in_pulses = true;
  std::string minimum_speed;
  for (const auto& [letter, value] : arguments.values()) {
    const Parameter* parameter = find_parameter(row, letter);
    if (letter == "u") in_pulses = counts_pulses(value);
    all_in_pulses = all_in_pulses && in_pulses;
    if (parameter->kind != Parameter::Kind::decimal) continue;
    // S and F come after all distances, and use their units.
    const bool behind = letter == "spds" || letter == "spdf";
    if (behind ? all_in_pulses : in_pulses) {
      const auto whole = to_pulses({*parse_decimal(value), Unit::pulses}, Scale{});
      if (!whole || *whole < parameter->minimum || *whole > parameter->maximum) {
        return out_of_range(row, *parameter, value);
      }
    }
    if (letter == "spds") minimum_speed = value;
    if (letter != "spdf" || minimum_speed.empty()) continue;
    if (exceeds(*parse_decimal(minimum_speed), *parse_decimal(value))) {
      return fail(
          Reason::out_of_range,
          fmt::format("{}: the minimum speed S {} exceeds the maximum speed F {}", row.name, minimum_speed, value),
          "set F to S or higher");
    }
  }
  return {};
}

constexpr std::size_t kRepeatsMax = kLetteredAxes.count();

// Returns how often a {...} must be repeated; 0 if W or missing axes leave the number open.
std::size_t axes_named(const Arguments& arguments) {
  const auto letter = arguments.first("a");
  if (!letter || *letter == "W") return 0;
  const auto axes = from_command_letter(letter->front(), kLetteredAxes);
  return axes ? static_cast<std::size_t>(axes->count()) : 0;
}

class Encoder {
 public:
  Encoder(const CommandRow& row, const Arguments& arguments) : row_(row), values_(arguments.values()) {
    expected_repeats_ = axes_named(arguments);
  }

  Result<std::string> run() {
    if (auto done = write(row_.format); !done) return tl::unexpected(done.error());
    if (next_ != values_.size()) return misfit();
    return std::move(out_);
  }

 private:
  tl::unexpected<Problem> misfit() const {
    return fail(Reason::invalid_request, fmt::format("the parameters do not fit {} ({})", row_.name, row_.format));
  }
  bool next_is(std::string_view letter) const { return next_ < values_.size() && values_[next_].first == letter; }

  Result<void> write(std::string_view format) {
    while (!format.empty()) {
      if (format.front() == '<') {
        const auto letter = first_letter(format);
        if (!next_is(letter)) return misfit();
        const auto& value = values_[next_++].second;
        if (auto good = check_value(row_, *find_parameter(row_, letter), value); !good) return good;
        out_ += value;
        format.remove_prefix(letter.size() + 2);
      } else if (format.front() == '[') {
        const auto [inner, rest] = split_group(format, '[', ']');
        if (next_is(first_letter(inner))) {
          if (auto done = write(inner); !done) return done;
        }
        format = rest;
      } else if (format.front() == '{') {
        const auto [inner, rest] = split_group(format, '{', '}');
        if (auto done = write_repeated(split_repeated(inner)); !done) return done;
        format = rest;
      } else {
        out_ += format.front();
        format.remove_prefix(1);
      }
    }
    return {};
  }

  Result<void> write_repeated(Repeated part) {
    std::size_t count = 0;
    while (next_is(first_letter(part.once))) {
      if (count++ > 0) out_ += part.separator;
      if (auto done = write(part.once); !done) return done;
    }
    if (count == 0 || count > kRepeatsMax || (expected_repeats_ != 0 && count != expected_repeats_)) return misfit();
    return {};
  }

  const CommandRow& row_;
  const std::vector<std::pair<std::string, std::string>>& values_;
  std::size_t next_ = 0;
  std::size_t expected_repeats_ = 0;
  std::string out_;
};

// Greedy: an optional part of a format never has to return text that it has taken.
class Decoder {
 public:
  Decoder(const CommandRow& row, std::string_view text) : row_(row), text_(text) {}

  std::optional<Arguments> run() {
    if (!read(row_.format) || !text_.empty()) return {};
    return std::move(arguments_);
  }

 private:
  bool read(std::string_view format) {
    while (!format.empty()) {
      if (format.front() == '<') {
        const auto letter = first_letter(format);
        if (!read_value(*find_parameter(row_, letter))) return false;
        format.remove_prefix(letter.size() + 2);
      } else if (format.front() == '[') {
        const auto [inner, rest] = split_group(format, '[', ']');
        const auto saved_text = text_;
        const auto saved_arguments = arguments_;
        if (!read(inner)) {
          text_ = saved_text;
          arguments_ = saved_arguments;
        }
        format = rest;
      } else if (format.front() == '{') {
        const auto [inner, rest] = split_group(format, '{', '}');
        if (!read_repeated(split_repeated(inner))) return false;
        format = rest;
      } else {
        if (text_.empty() || text_.front() != format.front()) return false;
        text_.remove_prefix(1);
        format.remove_prefix(1);
      }
    }
    return true;
  }

  bool read_repeated(Repeated part) {
    const std::size_t expected = axes_named(arguments_);
    std::size_t count = 0;
    while (expected == 0 ? (count < kRepeatsMax && !text_.empty()) : count < expected) {
      const auto saved_text = text_;
      const auto saved_arguments = arguments_;
      if (count > 0) {
        if (!text_.starts_with(part.separator)) break;
        text_.remove_prefix(part.separator.size());
      }
      if (!read(part.once)) {
        if (expected != 0 || count == 0) return false;
        text_ = saved_text;
        arguments_ = saved_arguments;
        break;
      }
      ++count;
    }
    return count > 0 && (expected == 0 || count == expected);
  }

  bool read_value(const Parameter& parameter) {
    std::string_view taken;
    if (parameter.kind == Parameter::Kind::choice) {
      taken = text_.substr(0, choice_length(parameter.choices, text_));
      const auto number = number_chosen(parameter.choices, text_);
      if (number.size() > taken.size()) taken = number;
      if (!taken.empty()) {
        text_.remove_prefix(taken.size());
      } else if (parameter.choices == "+ -") {
        taken = "+";  // "If there is no sign, it will be +" (manual 83), 88)); clients omit it elsewhere too
      } else if (parameter.letter == "u" && !text_.empty() && text_.front() >= '0' && text_.front() <= '9') {
        taken = parameter.choices.substr(0, 1);  // pulses: P for a distance, F for a speed
      } else {
        return false;
      }
    } else if (parameter.kind == Parameter::Kind::text) {
      taken = std::exchange(text_, {});
      if (taken.empty()) return false;
    } else {
      std::size_t end = 0;
      while (end < text_.size() && ((text_[end] >= '0' && text_[end] <= '9') ||
                                    (text_[end] == '.' && parameter.kind != Parameter::Kind::integer))) {
        ++end;
      }
      if (end == 0) return false;
      taken = text_.substr(0, end);
      text_.remove_prefix(end);
    }
    arguments_.add(parameter.letter, std::string(taken));
    return true;
  }

  const CommandRow& row_;
  std::string_view text_;
  Arguments arguments_;
};

std::string normalised(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == ' ' && !out.empty() && out.back() == ',') continue;
    out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return out;
}

}  // namespace

Arguments& Arguments::add(std::string_view letter, std::string value) {
  values_.emplace_back(letter, std::move(value));
  return *this;
}

// Axes without a letter make an argument that no row accepts.
Arguments& Arguments::axes(AxisSet axes) {
  const auto letter = command_letter(axes);
  return add("a", letter ? std::string(1, *letter) : to_string(axes));
}

Arguments& Arguments::pulses(std::int64_t signed_pulses) {
  return add("m", signed_pulses < 0 ? "-" : "+")
      .add("u", "P")
      .add("y", std::to_string(signed_pulses < 0 ? -signed_pulses : signed_pulses));
}

Arguments& Arguments::speeds(std::int64_t minimum, std::int64_t maximum, int acceleration_ms) {
  return add("spds", std::to_string(minimum))
      .add("spdf", std::to_string(maximum))
      .add("r", std::to_string(acceleration_ms));
}

std::optional<std::string> Arguments::first(std::string_view letter) const {
  for (const auto& [name, value] : values_) {
    if (name == letter) return value;
  }
  return {};
}

Result<std::string> encode(const CommandRow& row, const Arguments& arguments) {
  auto line = Encoder(row, arguments).run();
  if (!line) return line;
  if (auto good = check_amounts(row, arguments); !good) return tl::unexpected(good.error());
  return line;
}

std::optional<Result<Arguments>> decode(const CommandRow& row, std::string_view text) {
  const std::string normal = normalised(text);
  auto arguments = Decoder(row, normal).run();
  if (!arguments) return {};
  if (auto line = encode(row, *arguments); !line) return Result<Arguments>(tl::unexpected(line.error()));
  return Result<Arguments>(*arguments);
}

}  // namespace axisgate::shot
