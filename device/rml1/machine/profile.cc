#include "device/rml1/machine/profile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "device/config/config_file.h"
#include "device/config/config_table.h"

namespace axisgate::rml1 {
namespace {

constexpr double kMmMax = 10'000, kStepsMax = 1'000'000, kSpeedMax = 10'000;

constexpr std::array<std::pair<std::string_view, Spindle::Law>, 3> kLaws = {
    {{"fixed", Spindle::Law::fixed}, {"stages", Spindle::Law::stages}, {"direct", Spindle::Law::direct}}};
constexpr std::array<std::pair<std::string_view, bool>, 2> kRotaryUnits = {{{"degrees", false}, {"hundredths", true}}};
constexpr std::array<std::pair<std::string_view, bool>, 2> kFlatCommands = {{{"raise", false}, {"hold", true}}};

class ProfileReader {
 public:
  ProfileReader(std::string_view file, std::vector<ConfigError>& errors) : file_(file), errors_(errors) {}

  Profile read(const toml::table& source) {
    Profile profile;
    ConfigTable root(source, "", file_, errors_);
    profile.name = needed(root, "name", root.text("name"), "the machine's name");
    if (profile.name.empty() && root.has("name")) root.error("name", "is empty; use the machine's name");
    constexpr std::string_view kStep = "the displacement of one step in mm, 0.0001 to 10";
    profile.step_mm = needed(root, "step_mm", root.number("step_mm", 0.0001, 10, kStep), kStep);
    section(root, "area", [&](ConfigTable& table) { read_area(table, profile); });
    section(root, "z", [&](ConfigTable& table) { read_z(table, profile); });
    section(root, "tool", [&](ConfigTable& table) { read_tool(table, profile); });
    section(root, "speed", [&](ConfigTable& table) { read_speed(table, profile.speed); });
    section(root, "acceleration", [&](ConfigTable& table) { read_acceleration(table, profile.acceleration); });
    section(root, "spindle", [&](ConfigTable& table) { read_spindle(table, profile.spindle); });
    section(
        root, "line", [&](ConfigTable& table) { read_line(table, profile); }, false);
    section(
        root, "axes", [&](ConfigTable& table) { read_axes(table, profile); }, false);
    section(
        root, "rotary", [&](ConfigTable& table) { read_rotary(table, profile); }, false);
    section(
        root, "extras", [&](ConfigTable& table) { read_extras(table, profile); }, false);
    section(
        root, "clipping", [&](ConfigTable& table) { read_clipping(table, profile); }, false);
    root.refuse_unknown();
    return profile;
  }

 private:
  template <class Read>
  void section(ConfigTable& root, std::string_view key, Read read, bool is_needed = true) {
    const toml::table* source = root.table(key);
    if (source == nullptr) {
      if (is_needed && !root.has(key)) root.missing(key, "a table: " + std::string(key) + " of the machine");
      return;
    }
    ConfigTable table(*source, std::string(key), file_, errors_);
    read(table);
    table.refuse_unknown();
  }

  template <class T>
  static T needed(ConfigTable& table, std::string_view key, std::optional<T> value, std::string_view allowed) {
    if (!value && !table.has(key)) table.missing(key, allowed);
    return value.value_or(T{});
  }

  static double above_zero(ConfigTable& table, std::string_view key, double most, std::string_view allowed) {
    const auto value = table.number(key, 0, most, allowed);
    if (value && *value <= 0) table.error(key, "must be above zero; use " + std::string(allowed));
    return needed(table, key, value, allowed);
  }

  static double speed(ConfigTable& table, std::string_view key) {
    return above_zero(table, key, kSpeedMax, "a speed in mm/s above 0");
  }

  static double steps(ConfigTable& table, std::string_view key) {
    constexpr std::string_view kAllowed = "a number of steps";
    return needed(table, key, table.number(key, -kStepsMax, kStepsMax, kAllowed), kAllowed);
  }

  static void read_area(ConfigTable& table, Profile& profile) {
    profile.x_mm = above_zero(table, "x_mm", kMmMax, "the travel of X in mm");
    profile.y_mm = above_zero(table, "y_mm", kMmMax, "the travel of Y in mm");
    profile.z_mm = above_zero(table, "z_mm", kMmMax, "the travel of Z in mm");
  }

  static void read_z(ConfigTable& table, Profile& profile) {
    profile.top = steps(table, "top");
    constexpr std::string_view kAllowed = "1 where machine coordinates of Z grow upward, or -1";
    const auto up = table.integer("up", -1, 1);
    if (up == 0) table.error("up", "0 will not do; use " + std::string(kAllowed));
    profile.up = static_cast<int>(needed(table, "up", up, kAllowed));
    profile.default_z0 = steps(table, "default_z0");
  }

  static void read_tool(ConfigTable& table, Profile& profile) {
    profile.default_z1 = steps(table, "default_z1");
    if (profile.default_z1 > 0) table.error("default_z1", "lies above Z0; use 0 or less");
    profile.default_z2 = table.number("default_z2", 0, kStepsMax, "a number of steps above Z0");
  }

  void read_speed(ConfigTable& table, Speeds& speeds) {
    speeds.travel = speed(table, "travel");
    speeds.travel_z = speed(table, "travel_z");
    read_range(table, "cutting", speeds.cutting_minimum, speeds.cutting_maximum, speeds.cutting_default);
    read_range(table, "z", speeds.z_minimum, speeds.z_maximum, speeds.z_default);
  }

  void read_range(ConfigTable& table, const std::string& what, double& lowest, double& highest, double& otherwise) {
    const std::size_t errors = errors_.size();
    lowest = speed(table, what + "_minimum");
    highest = speed(table, what + "_maximum");
    otherwise = speed(table, what + "_default");
    if (errors_.size() != errors) return;
    if (lowest > highest) {
      table.error(what + "_minimum", "is more than " + what + "_maximum");
    } else if (otherwise < lowest || otherwise > highest) {
      table.error(what + "_default", "does not lie between " + what + "_minimum and " + what + "_maximum");
    }
  }

  void read_acceleration(ConfigTable& table, Acceleration& acceleration) {
    const std::size_t errors = errors_.size();
    constexpr std::string_view kAllowed = "an acceleration in mm/s2 above 0";
    acceleration.best = above_zero(table, "best", 1e6, kAllowed);
    acceleration.worst = above_zero(table, "worst", 1e6, kAllowed);
    acceleration.slower = table.number("slower", 0, 10, "a part from 0 to 10, 0.5").value_or(0);
    if (errors_.size() == errors && acceleration.worst > acceleration.best) table.error("worst", "is more than best");
  }

  void read_spindle(ConfigTable& table, Spindle& spindle) {
    const std::size_t errors = errors_.size();
    const auto law = table.choice<Spindle::Law>("speeds", kLaws);
    if (!law && !table.has("speeds")) table.missing("speeds", "\"fixed\", \"stages\" or \"direct\"");
    spindle.law = law.value_or(Spindle::Law::fixed);
    constexpr std::string_view kRpm = "revolutions per minute";
    spindle.minimum_rpm = above_zero(table, "minimum_rpm", 1e6, kRpm);
    spindle.maximum_rpm = above_zero(table, "maximum_rpm", 1e6, kRpm);
    if (errors_.size() == errors && spindle.minimum_rpm > spindle.maximum_rpm)
      table.error("minimum_rpm", "is more than maximum_rpm");
    spindle.stage_0_rpm = table.number("stage_0_rpm", 0, 1e6, kRpm);
    spindle.rpm_per_stage = table.number("rpm_per_stage", 0, 1e6, kRpm);
    constexpr std::string_view kSeconds = "seconds from 0 to 600";
    spindle.spin_up_s = needed(table, "spin_up_s", table.number("spin_up_s", 0, 600, kSeconds), kSeconds);
  }

  static void read_line(ConfigTable& table, Profile& profile) {
    if (const auto baud = table.integer("baud", 300, 10'000'000)) profile.baud = static_cast<int>(*baud);
  }

  static void read_axes(ConfigTable& table, Profile& profile) {
    if (const auto letters = table.text("letters")) profile.axes = *letters;
    if (profile.axes.find_first_not_of("XYZ") != std::string::npos) {
      table.error("letters", "will not do; use X, Y and Z: an axis of rotation has a table of its own, [rotary]");
    }
    const auto capital = [](char c) { return c >= 'A' && c <= 'Z'; };
    for (const std::string& pair : table.texts("apart").value_or(std::vector<std::string>{})) {
      if (pair.size() == 2 && capital(pair[0]) && capital(pair[1])) {
        profile.dialect.apart.push_back(pair);
      } else {
        table.error("apart", "\"" + pair + "\" will not do; use two capital letters, \"YA\"");
      }
    }
  }

  static void read_rotary(ConfigTable& table, Profile& profile) {
    Rotary rotary;
    const std::string letter = needed(table, "letter", table.text("letter"), "the letter of the axis, \"A\"");
    if (letter.size() == 1 && letter[0] >= 'A' && letter[0] <= 'W') {
      rotary.letter = letter[0];
    } else if (table.has("letter")) {
      table.error("letter", "will not do; use one capital letter that is not X, Y or Z, \"A\"");
    }
    rotary.hundredths = table.choice<bool>("unit", kRotaryUnits).value_or(false);
    rotary.degrees_per_s = above_zero(table, "speed_degrees_per_s", 1e5, "degrees per second");
    profile.rotary = rotary;
  }

  static void read_extras(ConfigTable& table, Profile& profile) {
    for (const std::string& extra : table.texts("tolerated").value_or(std::vector<std::string>{})) {
      if (extra == "J" || extra == "!0" || extra == "!1") {
        profile.dialect.tolerated.push_back(extra);
      } else {
        table.error("tolerated", "\"" + extra + "\" is not known; use any of \"J\", \"!0\", \"!1\"");
      }
    }
  }

  static void read_clipping(ConfigTable& table, Profile& profile) {
    profile.holds_flat_commands = table.choice<bool>("flat_commands", kFlatCommands).value_or(false);
  }

  std::string_view file_;
  std::vector<ConfigError>& errors_;
};

}  // namespace

double Spindle::rpm(double n) const {
  if (law == Law::fixed) return maximum_rpm;
  if (n >= 100 && law == Law::direct) return std::clamp(n, minimum_rpm, maximum_rpm);
  const double stage = std::min(n, 15.0);
  const double even = (maximum_rpm - minimum_rpm) / 15;
  const double reported = stage_0_rpm.value_or(minimum_rpm) + stage * rpm_per_stage.value_or(even);
  return std::clamp(reported, minimum_rpm, maximum_rpm);
}

Configured<Profile> parse_profile(std::string_view text, const std::string& file) {
  std::vector<ConfigError> errors;
  Profile profile;
  try {
    profile = ProfileReader(file, errors).read(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    errors.push_back({file, error.source().begin.line, "", "is not TOML: " + std::string(error.description())});
  }
  if (errors.empty()) return profile;
  const auto by_line = [](const ConfigError& a, const ConfigError& b) { return a.line < b.line; };
  std::stable_sort(errors.begin(), errors.end(), by_line);
  return tl::unexpected(std::move(errors));
}

Configured<Profile> load_profile(const std::string& file) {
  const auto text = read_config_file(file);
  if (!text) return tl::unexpected(std::vector<ConfigError>{{file, 0, "", text.error()}});
  return parse_profile(*text, file);
}

}  // namespace axisgate::rml1
