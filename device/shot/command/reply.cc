#include "device/shot/command/reply.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "device/core/guard.h"
#include "device/shot/command/trigger_reply.h"

namespace axisgate::shot {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool all_digits(std::string_view text) { return !text.empty() && std::ranges::all_of(text, is_digit); }

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, text) != words.end();
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> fields;
  while (true) {
    const auto comma = text.find(',');
    std::string_view field = text.substr(0, comma);
    while (field.starts_with(' ')) field.remove_prefix(1);
    fields.emplace_back(field);
    if (comma == std::string_view::npos) return fields;
    text.remove_prefix(comma + 1);
  }
}

std::string_view without_sign(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  return text;
}

bool is_decimal(std::string_view text) {
  const auto point = text.find('.');
  if (point == std::string_view::npos) return all_digits(text);
  return all_digits(text.substr(0, point)) && all_digits(text.substr(point + 1));
}

// A coordinate has a fixed width: a sign, blanks, digits (manual 4) Q:).
bool is_coordinate(std::string_view field) {
  const auto digits = without_sign(field);
  if (digits.size() == field.size()) return false;
  const auto begin = digits.find_first_not_of(' ');
  return begin != std::string_view::npos && all_digits(digits.substr(begin));
}

// An amount: M-1, U+2000, U0.00, or 0 for an invalid axis (manual 5) Q:S).
bool is_amount(std::string_view field) {
  if (field == "0") return true;
  if (field.empty() || std::string_view("PNUMD").find(field.front()) == std::string_view::npos) return false;
  return is_decimal(without_sign(field.substr(1)));
}

bool is_speed(std::string_view field) { return parse_speed_setting(field).has_value(); }

// A line setting: NS, or the letter of the axes and their signed amounts (manual 24) ?:K).
bool is_line_setting(std::string_view line) {
  if (line == "NS") return true;
  const auto fields = split(line);
  if (fields.size() < 3 || !is_one_of(fields[0], {"A", "B", "C", "D"})) return false;
  return std::ranges::all_of(fields.begin() + 1, fields.end(),
                             [](const std::string& field) { return is_decimal(without_sign(field)); });
}

// An arc setting: NS, or the kind of arc from 0 to 5, the axes, the direction of rotation and amounts (manual 22) ?:E).
bool is_arc_setting(std::string_view line) {
  if (line == "NS") return true;
  const auto fields = split(line);
  if (fields.size() < 5 || fields[0].size() != 1 || fields[0][0] < '0' || fields[0][0] > '5') return false;
  return is_one_of(fields[1], {"A", "B", "C"}) &&
         std::ranges::all_of(fields.begin() + 2, fields.end(),
                             [](const std::string& field) { return is_decimal(without_sign(field)); });
}

// V2.00.000
bool is_version(std::string_view line) {
  return line.size() >= 2 && line[0] == 'V' &&
         std::ranges::all_of(line.substr(1), [](char c) { return is_digit(c) || c == '.'; });
}

bool is_model(std::string_view line) {
  return line.size() >= 5 && line.find('-') != std::string_view::npos &&
         std::ranges::all_of(line, [](char c) { return is_digit(c) || (c >= 'A' && c <= 'Z') || c == '-'; });
}

bool is_mode(std::string_view line) {
  return is_one_of(line, {"HOST", "HOST,PROGRAM", "HOST,MS", "MANUAL", "REMOTE", "TEACHING", "EDIT", "LOAD", "TEST"});
}

bool is_echo(std::string_view line) {
  return line.size() > 1 && std::ranges::all_of(line, [](char c) { return c >= ' ' && c <= '~'; }) &&
         !is_one_of(line, {"OK", "OK_D", "NG", "NG_I"});
}

// A line of a program: a word or a letter, and its values (manual 115)).
bool is_step(std::string_view line) {
  return is_echo(line) && is_one_of(line.substr(0, line.find(',')), {"M", "A", "K", "E", "EH", "CM", "CA", "PAV", "H",
                                                                     "Z", "R", "INPUT", "F", "N", "END", "NONE"});
}

// Removes the next ':'-separated number from `spec` and returns it.
std::int64_t take_number(std::string_view& spec) {
  const auto end = spec.find(':');
  const auto number = *parse_integer(spec.substr(0, end));
  spec = end == std::string_view::npos ? std::string_view() : spec.substr(end + 1);
  return number;
}

struct Range {
  std::string_view kind;
  NumberRange range;
};

std::optional<Range> parse_range(std::string_view spec) {
  const auto colon = spec.find(':');
  if (colon == std::string_view::npos) return {};
  std::string_view numbers = spec.substr(colon + 1);
  const auto minimum = take_number(numbers);
  return Range{spec.substr(0, colon), {minimum, take_number(numbers)}};
}

bool is_number(std::string_view field) {
  if (field.starts_with('-')) field.remove_prefix(1);
  return all_digits(field) && field.size() <= 9;
}

bool field_matches(std::string_view spec, std::string_view field) {
  if (const auto range = parse_range(spec)) {
    if (range->kind == "number_or_NS" && field == "NS") return true;
    if (!is_number(field)) return false;
    const auto number = parse_integer(field);
    return number && *number >= range->range.minimum && *number <= range->range.maximum;
  }
  if (spec == "ready") return is_one_of(field, {"R", "B", "D"});
  if (spec == "error") return is_one_of(field, {"X", "K"});
  if (spec == "stop") return is_one_of(field, {"R", "K"}) || (field.size() == 1 && from_status_letter(field[0]));
  if (spec == "coordinate") return is_coordinate(field);
  if (spec == "amount") return is_amount(field);
  if (spec == "setting") return field == "NS" || is_decimal(without_sign(field));
  if (spec == "decimal") return is_decimal(field);
  if (spec == "speed") return is_speed(field);
  if (spec == "axis_name") {
    return field.size() == 1 && ((field[0] >= '1' && field[0] <= '9') || (field[0] >= 'A' && field[0] <= 'Z'));
  }
  if (spec == "direction") return is_one_of(field, {"+", "-", "NS"});
  if (spec == "config") return is_one_of(field, {"0", "1", "E", "D"});
  if (spec == "hex") {
    return !field.empty() && field.size() <= 8 &&
           std::ranges::all_of(field, [](char c) { return is_digit(c) || (c >= 'A' && c <= 'F'); });
  }
  return false;
}

// Replies that are matched as a whole: their commas do not separate fields.
std::optional<bool> whole_line_matches(const Model& model, std::string_view spec, std::string_view line) {
  if (spec == "identity") return parse_identity(line).has_value();
  if (spec == "version") return is_version(line);
  if (spec == "model") return is_model(line);
  if (spec == "mode") return is_mode(line);
  if (spec == "format") return is_one_of(line, {"SHOT_FC", "HIT"});
  if (spec == "serial") return line.size() >= 4 && all_digits(line);
  if (spec == "echo") return is_echo(line);
  if (spec == "line") return is_line_setting(line);
  if (spec == "arc") return is_arc_setting(line);
  if (spec == "step") return is_step(line);
  if (spec == "trigger") return parse_trigger(line, model.axes()).has_value();
  return {};
}

// A comma is part of a mode's name (manual 37) HOST,PROGRAM) and of the line that ?:CMD quotes (manual 40) WI:W,C).
bool is_one_field(std::string_view spec) { return spec == "mode" || spec == "echo"; }

bool fields_match(std::string_view specs, const std::vector<std::string>& fields, std::size_t per_axis) {
  std::size_t next = 0;
  for (const auto& spec : split(specs)) {
    const bool repeated = spec.ends_with('*');
    const auto kind = std::string_view(spec).substr(0, spec.size() - (repeated ? 1 : 0));
    for (std::size_t i = 0; i < (repeated ? per_axis : 1); ++i) {
      if (next >= fields.size() || !field_matches(kind, fields[next++])) return false;
    }
  }
  return next == fields.size();
}

// An answer has every controllable axis or, if invalid axes are shown as 0 and D (manual 5)), all of the model; a
// question that names its axes receives only those.
bool data_matches(const Model& model, const CommandRow& row, std::string_view line,
                  const std::vector<std::string>& fields, int axis_count) {
  if (const auto whole = whole_line_matches(model, row.reply, line)) return *whole;
  if (row.reply == "numbers") return fields.size() > 1 && std::ranges::all_of(fields, is_number);
  if (row.reply.find('*') == std::string_view::npos) return fields_match(row.reply, fields, 0);
  for (int count = 1; count <= model.axis_count(); ++count) {
    const bool fits =
        axis_count == 0 || count == axis_count || count == model.axis_count() || row.separation == Separation::grammar;
    if (fits && fields_match(row.reply, fields, static_cast<std::size_t>(count))) return true;
  }
  return false;
}

}  // namespace

std::optional<Reply> parse_reply(const Model& model, const CommandRow& row, std::string_view line, int axis_count) {
  const bool is_setting = row.reply.starts_with("OK");
  Reply reply{Reply::Kind::data, std::string(line), {}};
  if (line == "NG" || line == "NG_I") {
    reply.kind = line == "NG" ? Reply::Kind::ng : Reply::Kind::ng_i;
    return reply;
  }
  if (is_setting) {
    if (line == "OK" || !guarded(Guard::setter_grammar)) {
      reply.kind = Reply::Kind::ok;
      return reply;
    }
    if (line == "OK_D" && row.may_chain()) {
      reply.kind = Reply::Kind::ok_d;
      return reply;
    }
    return {};
  }
  reply.fields = is_one_field(row.reply) ? std::vector{reply.text} : split(line);
  if (guarded(Guard::question_grammar) && !data_matches(model, row, line, reply.fields, axis_count)) return {};
  return reply;
}

std::optional<NumberRange> bare_number_range(const CommandRow& row) {
  if (row.reply.starts_with("decimal")) return NumberRange{0, 999'999'999};
  if (row.reply.starts_with("setting")) return NumberRange{-999'999'999, 999'999'999};
  if (row.reply.starts_with("config")) return NumberRange{0, 1};
  if (row.reply.starts_with("axis_name")) return NumberRange{1, 9};
  std::string_view spec = row.reply;
  if (spec.ends_with('*')) spec.remove_suffix(1);
  const auto range = parse_range(spec);
  if (!range) return {};
  return range->range;
}

std::optional<Identity> parse_identity(std::string_view line) {
  const auto fields = split(line);
  if (fields.size() != 4 || !std::ranges::none_of(fields, &std::string::empty)) return {};
  if (fields[0].size() < 2 || !all_digits(fields[2]) || !is_version(fields[3])) return {};
  return Identity{fields[0], fields[1], fields[2], fields[3]};
}

std::map<int, std::string> by_axis(const Model& model, const Reply& reply, AxisSet controllable) {
  const bool all = reply.fields.size() == static_cast<std::size_t>(model.axis_count());
  const auto named = (all ? model.axes() : controllable).list();
  std::map<int, std::string> fields;
  if (named.size() != reply.fields.size()) return fields;
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (controllable.has(named[i])) fields[named[i]] = reply.fields[i];
  }
  return fields;
}

std::optional<std::vector<AxisReading>> parse_positions(const Model& model, const Reply& reply, AxisSet controllable) {
  const auto all = static_cast<std::size_t>(model.axis_count());
  const std::size_t count = reply.fields.size() / 3;
  if (reply.fields.size() != 3 * count || count == 0 || count > all) return {};
  const auto named = (count == all ? model.axes() : controllable).list();
  if (named.size() != count) return {};
  std::vector<AxisReading> readings(all);
  for (std::size_t i = 0; i < count; ++i) {
    auto& reading = readings[static_cast<std::size_t>(named[i] - 1)];
    std::string_view amount = reply.fields[i];
    const std::string_view hex = reply.fields[count + i], ready = reply.fields[2 * count + i];
    reading.valid = ready != "D";
    if (!reading.valid) continue;
    if (!amount.starts_with('P')) return {};
    const auto pulses = parse_integer(amount.substr(1));
    if (!pulses) return {};
    reading.pulses = *pulses;
    std::from_chars(hex.data(), hex.data() + hex.size(), reading.status.raw, 16);
    reading.busy = ready == "B";
  }
  return readings;
}

std::optional<SpeedSetting> parse_speed_setting(std::string_view field) {
  const auto f = field.find('F'), r = field.find('R');
  if (!field.starts_with('S') || f == std::string_view::npos || r == std::string_view::npos || r < f) return {};
  const auto minimum = parse_integer(field.substr(1, f - 1)), maximum = parse_integer(field.substr(f + 1, r - f - 1)),
             time = parse_integer(field.substr(r + 1));
  const auto within = [](const std::optional<std::int64_t>& value, std::int64_t most) {
    return value && *value >= 1 && *value <= most;
  };
  // Range of manual 89) D:. A number outside it is not a speed of an axis, and could not be sent back either.
  if (!within(minimum, 1'000'000) || !within(maximum, 1'000'000) || !within(time, 1000)) return {};
  return SpeedSetting{*minimum, *maximum, static_cast<int>(*time)};
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  const bool negative = text.starts_with('-');
  const auto digits = without_sign(text);
  if (!all_digits(digits) || digits.size() > 18) return {};
  std::int64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return negative ? -value : value;
}

}  // namespace axisgate::shot
