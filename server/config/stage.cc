#include "server/config/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>

#include "device/config/config_file.h"
#include "device/core/explain.h"
#include "device/core/quantity.h"
#include "server/config/quantity.h"
#include "server/config/words.h"

namespace axisgate::server {
namespace {

using stage::AxisLimits;
using stage::StageProfile;

constexpr std::size_t kModelMax = 64;

struct Limit {
  std::string_view key;
  std::optional<Quantity> AxisLimits::*value;
  int sign;  // 1: a greater value is beyond the limit; -1: a smaller one
};
constexpr std::array<Limit, 3> kLimits = {{{"travel_minimum", &AxisLimits::travel_minimum, -1},
                                           {"travel_maximum", &AxisLimits::travel_maximum, 1},
                                           {"maximum_speed", &AxisLimits::maximum_speed, 1}}};

Result<std::int64_t> whole_pulses(const Limit& limit, const Quantity& amount, const Scale& scale) {
  return limit.value == &AxisLimits::maximum_speed ? to_pulses_per_second(amount, scale) : to_pulses(amount, scale);
}

// The model appears in messages to people, so it must not contain a byte that controls a terminal.
std::string read_model(ConfigTable& table) {
  constexpr std::string_view kAllowed = "the stage's model, 1 to 64 printable ASCII characters";
  const std::optional<std::string> model = table.text("name");
  if (!model && !table.has("name")) table.missing("name", kAllowed);
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  const bool good = !model || (!model->empty() && model->size() <= kModelMax && std::ranges::all_of(*model, printable));
  if (!good) table.error("name", fmt::format("will not do; use {}", kAllowed));
  return model.value_or("");
}

// Reports whether `unit` fits a rotary or a linear stage; pulses fit both.
bool fits(Unit unit, bool rotary) { return unit == Unit::pulses || (unit == Unit::degrees) == rotary; }

Unit checked_unit(ConfigTable& table, bool rotary, Unit otherwise) {
  const std::optional<Unit> unit = read_unit(table, "unit");
  if (!unit) return otherwise;
  if (fits(*unit, rotary)) return *unit;
  table.error("unit", fmt::format("{} is for a stage that {}, and this one {}", symbol(*unit),
                                  rotary ? "slides" : "turns", rotary ? "turns" : "slides"));
  return otherwise;
}

Scale read_pulse(ConfigTable& table, bool rotary) {
  const std::string_view allowed = rotary ? "the displacement of one pulse as a text in quotes, \"0.0025deg\""
                                          : "the displacement of one pulse as a text in quotes, \"1um\"";
  const std::optional<std::string> text = table.text("pulse");
  if (!text && !table.has("pulse")) table.missing("pulse", allowed);
  if (!text) return {};
  const Result<Quantity> way = parse_quantity(*text, Unit::pulses);
  const Result<Scale> scale = way ? scale_of(*way) : tl::unexpected(way.error());
  if (!scale) {
    table.error("pulse", explain(scale.error()));
  } else if (scale->rotary != rotary) {
    table.error("pulse", fmt::format("is in {}, and the stage {}; use {}", symbol(way->unit),
                                     rotary ? "turns" : "slides", allowed));
  }
  return scale.value_or(Scale{});
}

std::optional<Decimal> read_modulo(ConfigTable& table, bool rotary) {
  const std::optional<std::string> text = table.text("modulo");
  if (!text) return std::nullopt;
  if (!rotary) {
    table.error("modulo", "is of rotary stages only; leave it out");
    return std::nullopt;
  }
  const Result<Quantity> turn = parse_quantity(*text, Unit::degrees);
  if (!turn) {
    table.error("modulo", explain(turn.error()));
    return std::nullopt;
  }
  if (turn->unit != Unit::degrees || turn->value.digits <= 0) {
    table.error("modulo", fmt::format("\"{}\" is no turn; use degrees above 0, \"360deg\"", *text));
    return std::nullopt;
  }
  return turn->value;
}

Stage read_profile(ConfigTable& table) {
  Stage stage;
  stage.profile.model = read_model(table);
  const std::optional<bool> kind = table.choice<bool>("kind", kStageKinds);
  if (!kind && !table.has("kind")) table.missing("kind", "\"linear\" or \"rotary\"");
  if (!kind) {
    // Without the kind, the units cannot be checked.
    for (const char* key : {"pulse", "unit", "travel_minimum", "travel_maximum", "maximum_speed", "modulo"}) {
      table.allow(key);
    }
    table.refuse_unknown();
    return stage;
  }
  stage.profile.pulse = read_pulse(table, *kind);
  stage.unit = checked_unit(table, *kind, *kind ? Unit::degrees : Unit::micrometers);
  read_bounds(table, stage.unit, stage.limits);
  stage.profile.modulo = read_modulo(table, *kind);
  if (stage.profile.pulse.rotary == *kind) check_whole_pulses(table, stage.profile, stage.limits);
  table.refuse_unknown();
  return stage;
}

std::optional<Stage> good_profile(const toml::table& source, std::string path, std::string_view file,
                                  std::vector<ConfigError>& errors) {
  const std::size_t before = errors.size();
  ConfigTable table(source, std::move(path), file, errors);
  Stage stage = read_profile(table);
  if (errors.size() > before) return std::nullopt;
  return stage;
}

}  // namespace

std::optional<Stage> read_stage(ConfigTable& axis, std::string_view file, std::vector<ConfigError>& errors) {
  if (axis.holds_table("stage")) return good_profile(*axis.table("stage"), "device.axis.stage", file, errors);
  const std::optional<std::string> given = axis.text("stage");
  if (!given) return std::nullopt;
  const std::string path = (std::filesystem::path(file).parent_path() / *given).string();
  const auto text = given->empty() ? tl::unexpected(std::string("names no file")) : read_config_file(path);
  if (!text) {
    axis.error("stage", fmt::format("{} {}; use the path of a stage profile, from the folder of this file on",
                                    given->empty() ? "\"\"" : path, text.error()));
    return std::nullopt;
  }
  try {
    const toml::table root = toml::parse(*text, path);
    return good_profile(root, "", path, errors);
  } catch (const toml::parse_error& error) {
    errors.push_back({path, error.source().begin.line, "", fmt::format("is not TOML: {}", error.description())});
    return std::nullopt;
  }
}

Unit unit_on(ConfigTable& axis, const Stage& stage) {
  return checked_unit(axis, stage.profile.pulse.rotary, stage.unit);
}

void check_whole_pulses(ConfigTable& table, const StageProfile& stage, const AxisLimits& limits) {
  for (const Limit& limit : kLimits) {
    if (!(limits.*limit.value)) continue;
    const auto pulses = whole_pulses(limit, *(limits.*limit.value), stage.pulse);
    if (!pulses) table.error(limit.key, explain(pulses.error()));
  }
}

void put_on_stage(ConfigTable& table, const Stage& stage, stage::AxisProfile& axis) {
  const Scale& scale = stage.profile.pulse;
  axis.stage = stage.profile;
  check_whole_pulses(table, stage.profile, axis);
  for (const Limit& limit : kLimits) {
    std::optional<Quantity>& own = axis.*limit.value;
    const std::optional<Quantity>& most = stage.limits.*limit.value;
    if (!own) own = most;
    if (!most) continue;
    const auto wanted = whole_pulses(limit, *own, scale), possible = whole_pulses(limit, *most, scale);
    if (!wanted || !possible || limit.sign * *wanted <= limit.sign * *possible) continue;
    table.error(limit.key, fmt::format("is beyond that of the stage, {}{}{} of the {}; an axis can only have less",
                                       to_string(most->value), symbol(most->unit),
                                       limit.key == "maximum_speed" ? "/s" : "", stage.profile.model));
  }
  const auto in_pulses = [&](const std::optional<Quantity>& place) {
    const auto pulses = place ? to_pulses(*place, scale) : Result<std::int64_t>(tl::unexpected(Problem{}));
    return pulses ? std::optional(*pulses) : std::nullopt;
  };
  const auto minimum = in_pulses(axis.travel_minimum), maximum = in_pulses(axis.travel_maximum);
  if (!minimum || !maximum || *minimum < *maximum) return;
  if (table.has("travel_minimum")) {
    table.error("travel_minimum", "must be below travel_maximum");
  } else {
    table.error("travel_maximum", "must be above travel_minimum");
  }
}

}  // namespace axisgate::server
