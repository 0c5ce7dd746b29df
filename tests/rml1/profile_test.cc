// Tests of machine profiles in files: each key, and the line of each error.
#include "device/rml1/machine/profile.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/paths/paths.h"

namespace axisgate::rml1 {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

const std::vector<std::string> kLines = {
    "name = \"Test\"",              // 1
    "step_mm = 0.025",              // 2
    "[area]",                       // 3
    "x_mm = 203.2",                 // 4
    "y_mm = 152.4",                 // 5
    "z_mm = 60.5",                  // 6
    "[z]",                          // 7
    "top = 10",                     // 8
    "up = -1",                      // 9
    "default_z0 = -20",             // 10
    "[tool]",                       // 11
    "default_z1 = -40",             // 12
    "default_z2 = 50",              // 13
    "[speed]",                      // 14
    "travel = 30",                  // 15
    "travel_z = 31",                // 16
    "cutting_minimum = 0.5",        // 17
    "cutting_maximum = 15",         // 18
    "cutting_default = 2",          // 19
    "z_minimum = 0.25",             // 20
    "z_maximum = 16",               // 21
    "z_default = 3",                // 22
    "[acceleration]",               // 23
    "best = 200",                   // 24
    "worst = 100",                  // 25
    "slower = 0.5",                 // 26
    "[spindle]",                    // 27
    "speeds = \"stages\"",          // 28
    "minimum_rpm = 1000",           // 29
    "maximum_rpm = 9000",           // 30
    "stage_0_rpm = 1500",           // 31
    "rpm_per_stage = 500",          // 32
    "spin_up_s = 4",                // 33
    "[line]",                       // 34
    "baud = 9600",                  // 35
    "[axes]",                       // 36
    "letters = \"XZ\"",             // 37
    "apart = [\"YA\", \"XB\"]",     // 38
    "[rotary]",                     // 39
    "letter = \"B\"",               // 40
    "unit = \"hundredths\"",        // 41
    "speed_degrees_per_s = 20",     // 42
    "[extras]",                     // 43
    "tolerated = [\"J\", \"!1\"]",  // 44
    "[clipping]",                   // 45
    "flat_commands = \"hold\"",     // 46
};

std::string key_of(const std::string& line) { return line.substr(0, line.find(' ')); }

struct Found {
  std::size_t line = 0;     // counted from 1
  std::size_t section = 1;  // line at which its table begins
  std::string key;          // "area.x_mm"
};

std::vector<Found> keys() {
  std::vector<Found> found;
  std::string path;
  std::size_t section = 1;
  for (std::size_t index = 0; index < kLines.size(); ++index) {
    const std::string& line = kLines[index];
    if (line[0] == '[') {
      path = line.substr(1, line.size() - 2) + ".";
      section = index + 1;
    } else {
      found.push_back({index + 1, section, path + key_of(line)});
    }
  }
  return found;
}

const Found& where(const std::string& key) {
  static const std::vector<Found> kKeys = keys();
  return *std::find_if(kKeys.begin(), kKeys.end(), [&](const Found& one) { return one.key == key; });
}

// Returns the file with another text in line `number`.
std::string changed(std::size_t number, const std::string& line) {
  std::string text;
  for (std::size_t index = 0; index < kLines.size(); ++index) {
    text += (index + 1 == number ? line : kLines[index]) + "\n";
  }
  return text;
}
std::string with(const std::string& key, const std::string& value) {
  const Found& one = where(key);
  return changed(one.line, key_of(kLines[one.line - 1]) + " = " + value);
}

Configured<Profile> parsed(const std::string& text) { return parse_profile(text, "mill.toml"); }

// Returns errors as text: "17 speed.cutting_minimum".
std::vector<std::string> errors(const std::string& text) {
  std::vector<std::string> found;
  const auto profile = parsed(text);
  if (profile) return found;
  for (const ConfigError& error : profile.error()) {
    EXPECT_EQ(error.file, "mill.toml");
    found.push_back(fmt::format("{} {}", error.line, error.key));
  }
  return found;
}

TEST(Profile, HasWhatTheFileSays) {
  const auto found = parsed(changed(0, ""));
  ASSERT_TRUE(found.has_value());
  const Profile& mill = *found;
  EXPECT_EQ(mill.name, "Test");
  EXPECT_EQ(mill.step_mm, 0.025);
  EXPECT_EQ(mill.steps(60.5), 2420);
  EXPECT_THAT((std::vector{mill.x_mm, mill.y_mm, mill.z_mm}), ElementsAre(203.2, 152.4, 60.5));
  EXPECT_THAT((std::vector{mill.top, mill.default_z0, mill.default_z1}), ElementsAre(10, -20, -40));
  EXPECT_EQ(mill.up, -1);
  EXPECT_EQ(mill.default_z2, 50);
  const Speeds& speed = mill.speed;
  EXPECT_THAT((std::vector{speed.travel, speed.travel_z}), ElementsAre(30, 31));
  EXPECT_THAT((std::vector{speed.cutting_minimum, speed.cutting_maximum, speed.cutting_default}),
              ElementsAre(0.5, 15, 2));
  EXPECT_THAT((std::vector{speed.z_minimum, speed.z_maximum, speed.z_default}), ElementsAre(0.25, 16, 3));
  EXPECT_THAT((std::vector{mill.acceleration.best, mill.acceleration.worst, mill.acceleration.slower}),
              ElementsAre(200, 100, 0.5));
  EXPECT_EQ(mill.spindle.law, Spindle::Law::stages);
  EXPECT_THAT((std::vector{mill.spindle.minimum_rpm, mill.spindle.maximum_rpm, mill.spindle.spin_up_s}),
              ElementsAre(1000, 9000, 4));
  EXPECT_EQ(mill.spindle.stage_0_rpm, 1500);
  EXPECT_EQ(mill.spindle.rpm_per_stage, 500);
  EXPECT_EQ(mill.baud, 9600);
  EXPECT_EQ(mill.axes, "XZ");
  EXPECT_THAT(mill.dialect.apart, ElementsAre("YA", "XB"));
  ASSERT_TRUE(mill.rotary.has_value());
  EXPECT_EQ(mill.rotary->letter, 'B');
  EXPECT_TRUE(mill.rotary->hundredths);
  EXPECT_EQ(mill.rotary->degrees_per_s, 20);
  EXPECT_THAT(mill.dialect.tolerated, ElementsAre("J", "!1"));
  EXPECT_TRUE(mill.holds_flat_commands);
}

const std::vector<std::string> kOptional = {
    "tool.default_z2", "acceleration.slower", "spindle.stage_0_rpm", "spindle.rpm_per_stage", "line.baud",
    "axes.letters",    "axes.apart",          "rotary.unit",         "extras.tolerated",      "clipping.flat_commands"};

TEST(Profile, MayLackSomeKeys) {
  for (const std::string& key : kOptional) EXPECT_THAT(errors(changed(where(key).line, "")), IsEmpty()) << key;
  std::string text;
  for (std::size_t index = 0; index < 33; ++index) text += kLines[index] + "\n";
  const auto mill = parsed(text);
  ASSERT_TRUE(mill.has_value());
  EXPECT_FALSE(mill->baud.has_value());
  EXPECT_EQ(mill->axes, "XYZ");
  EXPECT_FALSE(mill->rotary.has_value());
  EXPECT_THAT(mill->dialect.apart, IsEmpty());
  EXPECT_THAT(mill->dialect.tolerated, IsEmpty());
  EXPECT_FALSE(mill->holds_flat_commands);
  EXPECT_FALSE(parsed(changed(13, ""))->default_z2.has_value());
}

TEST(Profile, TellsOfEachKeyThatIsMissing) {
  for (const Found& one : keys()) {
    if (std::find(kOptional.begin(), kOptional.end(), one.key) != kOptional.end()) continue;
    EXPECT_THAT(errors(changed(one.line, "")), Contains(fmt::format("{} {}", one.section, one.key))) << one.key;
  }
}

TEST(Profile, TellsOfEachTableThatIsMissing) {
  EXPECT_THAT(errors("name = \"A\"\nstep_mm = 1\n"),
              ElementsAre("1 area", "1 z", "1 tool", "1 speed", "1 acceleration", "1 spindle"));
}

TEST(Profile, TellsOfEachKeyOfAnotherType) {
  for (const Found& one : keys()) {
    const std::string wrong = one.key == "name" || kLines[one.line - 1].find('"') != std::string::npos ? "5" : "\"5\"";
    EXPECT_THAT(errors(with(one.key, wrong)), Contains(fmt::format("{} {}", one.line, one.key))) << one.key;
  }
}

struct Wrong {
  const char* key;
  std::vector<std::string> values;
};

TEST(Profile, TellsOfEachValueOutOfRange) {
  const std::vector<Wrong> all = {{"step_mm", {"0", "-0.01", "0.00009", "11", "nan"}},
                                  {"area.x_mm", {"0", "-1", "10001", "inf"}},
                                  {"area.y_mm", {"0", "-1", "10001"}},
                                  {"area.z_mm", {"0", "-1", "10001"}},
                                  {"z.top", {"1000001", "-1000001"}},
                                  {"z.up", {"0", "2", "-2", "1.0"}},
                                  {"z.default_z0", {"1000001", "-1000001"}},
                                  {"tool.default_z1", {"1", "-1000001"}},
                                  {"tool.default_z2", {"-1", "1000001"}},
                                  {"speed.travel", {"0", "-1", "10001"}},
                                  {"speed.travel_z", {"0", "-1", "10001"}},
                                  {"speed.cutting_minimum", {"0", "-1", "15.1"}},
                                  {"speed.cutting_maximum", {"0", "10001"}},
                                  {"speed.cutting_default", {"0", "0.4", "15.1"}},
                                  {"speed.z_minimum", {"0", "-1", "16.1"}},
                                  {"speed.z_maximum", {"0", "10001"}},
                                  {"speed.z_default", {"0", "0.2", "16.1"}},
                                  {"acceleration.best", {"0", "-1", "1000001"}},
                                  {"acceleration.worst", {"0", "-1", "201"}},
                                  {"acceleration.slower", {"-0.01", "10.1"}},
                                  {"spindle.speeds", {"\"often\"", "\"Fixed\""}},
                                  {"spindle.minimum_rpm", {"0", "9001"}},
                                  {"spindle.maximum_rpm", {"0", "1000001"}},
                                  {"spindle.stage_0_rpm", {"-1", "1000001"}},
                                  {"spindle.rpm_per_stage", {"-1", "1000001"}},
                                  {"spindle.spin_up_s", {"-1", "601"}},
                                  {"line.baud", {"0", "299", "10000001", "9600.5"}},
                                  {"axes.letters", {"\"xyz\"", "\"X1\"", "\"X Y\"", "\"XYZA\""}},
                                  {"axes.apart", {"[\"Y\"]", "[\"YAB\"]", "[\"ya\"]", "[1]", "[\"YA\", \"Y1\"]"}},
                                  {"rotary.letter", {"\"\"", "\"a\"", "\"AB\"", "\"1\"", "\"X\""}},
                                  {"rotary.unit", {"\"turns\""}},
                                  {"rotary.speed_degrees_per_s", {"0", "-1", "100001"}},
                                  {"extras.tolerated", {"[\"K\"]", "[\"!2\"]", "[\"j\"]", "[\"\"]"}},
                                  {"clipping.flat_commands", {"\"stop\""}}};
  for (const Wrong& one : all) {
    for (const std::string& value : one.values) {
      EXPECT_THAT(errors(with(one.key, value)), Contains(fmt::format("{} {}", where(one.key).line, one.key)))
          << one.key << " = " << value;
    }
  }
  // All keys except the name have been tested.
  EXPECT_EQ(all.size() + 1, keys().size());
}

TEST(Profile, TakesTheEndsOfEachRange) {
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{{"step_mm", "10"},
                                                                                   {"step_mm", "0.0001"},
                                                                                   {"area.x_mm", "10000"},
                                                                                   {"z.top", "-1000000"},
                                                                                   {"z.up", "1"},
                                                                                   {"tool.default_z1", "0"},
                                                                                   {"tool.default_z2", "0"},
                                                                                   {"speed.travel", "10000"},
                                                                                   {"speed.cutting_default", "15"},
                                                                                   {"speed.z_default", "0.25"},
                                                                                   {"acceleration.worst", "200"},
                                                                                   {"acceleration.slower", "0"},
                                                                                   {"spindle.minimum_rpm", "9000"},
                                                                                   {"spindle.spin_up_s", "0"},
                                                                                   {"line.baud", "300"},
                                                                                   {"axes.apart", "[]"}}) {
    EXPECT_THAT(errors(with(key, value)), IsEmpty()) << key;
  }
}

TEST(Profile, RefusesKeysThatItDoesNotKnow) {
  EXPECT_THAT(errors(changed(2, "step_mm = 0.01\nstep = 1")), ElementsAre("3 step"));
  for (const std::string table :
       {"area", "z", "tool", "speed", "acceleration", "spindle", "line", "axes", "rotary", "extras", "clipping"}) {
    const auto at = std::find(kLines.begin(), kLines.end(), "[" + table + "]");
    const auto line = static_cast<std::size_t>(at - kLines.begin()) + 1;
    EXPECT_THAT(errors(changed(line, "[" + table + "]\nmore = 1")),
                ElementsAre(fmt::format("{} {}.more", line + 1, table)));
  }
}

TEST(Profile, RefusesWhatIsNoTable) {
  EXPECT_THAT(errors("line = 9600\n" + changed(34, "[extra]")), Contains("1 line"));
}

TEST(Profile, TellsAllErrorsInTheOrderOfTheLines) {
  std::string text = with("line.baud", "1");
  text.replace(text.find("0.025"), 5, "-1");
  text.replace(text.find("203.2"), 5, "-1");
  EXPECT_THAT(errors(text), ElementsAre("2 step_mm", "4 area.x_mm", "35 line.baud"));
}

// A wrong limit is one error: the range that it would give causes no second one.
TEST(Profile, AWrongSpeedIsOneError) {
  EXPECT_THAT(errors(with("speed.cutting_maximum", "0")), ElementsAre("18 speed.cutting_maximum"));
}

TEST(Profile, TellsWhereTheFileIsNoToml) { EXPECT_THAT(errors(changed(5, "y_mm = = 3")), ElementsAre("5 ")); }

TEST(Profile, TellsOfAFileThatIsNotThere) {
  const auto found = load_profile("/nowhere/mill.toml");
  ASSERT_FALSE(found.has_value());
  ASSERT_EQ(found.error().size(), 1u);
  EXPECT_EQ(found.error()[0].file, "/nowhere/mill.toml");
  EXPECT_EQ(found.error()[0].line, 0u);
}

std::filesystem::path mills() { return paths::in_project("deploy/mills"); }

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string problems(const Configured<Profile>& found) {
  std::string all;
  if (found) return all;
  for (const ConfigError& error : found.error()) all += to_string(error) + "\n";
  return all;
}

TEST(Mills, AllLoad) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(mills())) {
    const auto found = load_profile(entry.path().string());
    ASSERT_EQ(problems(found), "");
    names.push_back(found->name);
    EXPECT_LE(found->speed.cutting_maximum, found->speed.travel) << found->name;
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("MDX-15", "MDX-20", "MDX-40", "MDX-50", "MDX-540", "SRM-20"));
}

// The shipped files offer more keys in comments: a profile with a comment sign removed must load.
TEST(Mills, LoadWithWhatTheirCommentsOffer) {
  std::size_t offered = 0;
  for (const auto& entry : std::filesystem::directory_iterator(mills())) {
    std::string text = text_of(entry.path());
    for (const std::string key : {"default_z2 =", "baud =", "stage_0_rpm =", "rpm_per_stage =", "[rotary]",
                                  "letter =", "unit =", "speed_degrees_per_s ="}) {
      const auto at = text.find("\n# " + key);
      if (at == std::string::npos) continue;
      text.erase(at + 1, 2);
      ++offered;
    }
    EXPECT_EQ(problems(parse_profile(text, entry.path().string())), "");
  }
  EXPECT_GE(offered, 10u);
}

TEST(Mills, Mdx15IsAsItsFileSays) {
  const auto mill = load_profile((mills() / "mdx-15.toml").string());
  ASSERT_EQ(problems(mill), "");
  EXPECT_EQ(mill->step_mm, 0.025);
  EXPECT_THAT((std::vector{mill->x_mm, mill->y_mm, mill->z_mm}), ElementsAre(152.4, 101.6, 60.5));
  EXPECT_EQ(mill->up, 1);
  EXPECT_FALSE(mill->default_z2.has_value());
  EXPECT_EQ(mill->spindle.law, Spindle::Law::fixed);
  EXPECT_EQ(mill->spindle.rpm(3124), 6500);
  EXPECT_EQ(mill->baud, 9600);
  EXPECT_TRUE(mill->dialect.tolerates("!1"));
  EXPECT_FALSE(mill->holds_flat_commands);
}

// The source says "makes 700 rpm a stage".
TEST(Mills, Mdx50HasStagesOf700) {
  const auto mill = load_profile((mills() / "mdx-50.toml").string());
  ASSERT_EQ(problems(mill), "");
  EXPECT_EQ(mill->spindle.rpm(0), 4500);
  EXPECT_EQ(mill->spindle.rpm(1), 5200);
  EXPECT_EQ(mill->spindle.rpm(15), 15000);
  EXPECT_EQ(mill->spindle.rpm(12000), 12000);
}

}  // namespace
}  // namespace axisgate::rml1
