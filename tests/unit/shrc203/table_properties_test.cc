// Properties of every row of the command table with any parameters, tested with random ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/shot/command/axes.h"
#include "device/shot/command/command.h"
#include "device/shot/command/pattern.h"
#include "device/shrc203/command/command_table.h"
#include "tests/unit/shrc203/table_samples.h"

namespace axisgate::shrc203::table_properties_test {
namespace {

constexpr std::uint64_t kSeed = 203'136;
constexpr int kTrials = 400;
// Number of each row's trials that are also shown to every other row, which takes the longest.
constexpr int kTrialsForOtherRows = 25;

using Kind = Parameter::Kind;
using Complaint = std::optional<std::string>;

// Returns nullopt if `written` is read as the row with the sample's arguments, and sent as the sample's line.
Complaint check_reading(const CommandRow& row, const Sample& sample, std::string_view written) {
  const auto command = model().parse(written);
  if (!command) return fmt::format("\"{}\" is refused: {}", written, command.error().message);
  if (command->row->name != row.name) return fmt::format("\"{}\" is read as {}", written, command->row->name);
  if (command->arguments != sample.arguments()) return fmt::format("\"{}\" is read otherwise", written);
  if (command->line != sample.line) return fmt::format("\"{}\" is sent as \"{}\"", written, command->line);
  return {};
}

Complaint check_round_trip(const CommandRow& row, const Sample& sample) {
  const auto line = encode(row, sample.arguments());
  if (!line) return fmt::format("not encoded: {}", line.error().message);
  if (*line != sample.line) return fmt::format("encoded as \"{}\"", *line);
  return check_reading(row, sample, *line);
}

// Returns the line as people write it: each letter in either case, and blanks after some commas.
std::string loosened(std::string_view line, SampleGenerator& random) {
  std::string loose;
  for (const char c : line) {
    loose += random.below(2) == 0 ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : c;
    if (c == ',') loose += std::string(random.below(3), ' ');
  }
  return loose;
}

Complaint check_claims(const CommandRow& row, const Sample& sample) {
  for (const CommandRow& other : model().commands()) {
    if (other.name != row.name && decode(other, sample.line)) return fmt::format("{} claims it as well", other.name);
  }
  return {};
}

// Checks that the value is refused with out_of_range as an argument, and also as a line if the line still has the row's
// shape.
Complaint check_refused(const CommandRow& row, const Sample& sample, std::size_t which, const std::string& value) {
  const Sample wrong = sample.with(which, value);
  const auto line = encode(row, wrong.arguments());
  if (line) return fmt::format("{} as {} is encoded", value, wrong.values[which].first);
  if (line.error().reason != Reason::out_of_range) return fmt::format("{}: {}", value, line.error().message);
  const auto command = model().parse(wrong.line);
  if (command) return fmt::format("\"{}\" is read as {}", wrong.line, command->row->name);
  const bool shaped = std::ranges::all_of(value, [](unsigned char c) { return std::isdigit(c) || c == '.'; });
  if (shaped && command.error().reason != Reason::out_of_range) {
    return fmt::format("\"{}\": {}", wrong.line, command.error().message);
  }
  return {};
}

const Parameter& parameter_of(const CommandRow& row, std::string_view letter) {
  return *std::ranges::find(row.parameters, letter, &Parameter::letter);
}

Complaint check_integers(const CommandRow& row, const Sample& sample) {
  for (std::size_t i = 0; i < sample.values.size(); ++i) {
    const Parameter& parameter = parameter_of(row, sample.values[i].first);
    if (parameter.kind != Kind::integer) continue;
    for (const auto& value : {std::to_string(parameter.minimum - 1), std::to_string(parameter.maximum + 1),
                              std::string("9223372036854775808"), std::string(40, '9')}) {
      if (auto complaint = check_refused(row, sample, i, value)) return complaint;
    }
  }
  return {};
}

// Checks numbers that are pulses according to the unit before them.
Complaint check_pulses(const CommandRow& row, const Sample& sample) {
  for (std::size_t i = 1; i < sample.values.size(); ++i) {
    const Parameter& parameter = parameter_of(row, sample.values[i].first);
    const auto& [letter, unit] = sample.values[i - 1];
    if (parameter.kind != Kind::decimal || letter != "u" || (unit != "P" && unit != "F")) continue;
    for (const auto& value : {std::to_string(parameter.minimum - 1), std::to_string(parameter.maximum + 1),
                              std::to_string(parameter.minimum + 1) + ".5"}) {
      if (auto complaint = check_refused(row, sample, i, value)) return complaint;
    }
  }
  return {};
}

// Runs each row's trials until the first failure: one failure a row is enough.
template <class Check>
void for_every_row(int trials, Check check) {
  for (const CommandRow& row : model().commands()) {
    for (int trial = 0; trial < trials; ++trial) {
      SampleGenerator random(row, kSeed + static_cast<std::uint64_t>(row.section * kTrials + trial));
      const Sample sample = random.sample();
      const Complaint complaint = check(row, sample, random);
      if (!complaint) continue;
      ADD_FAILURE() << "seed " << kSeed << ", trial " << trial << ", row " << row.name << " (" << row.format
                    << "), line \"" << sample.line << "\": " << *complaint;
      break;
    }
  }
}

TEST(TableProperties, WhatIsEncodedIsReadAsTheSame) {
  for_every_row(kTrials, [](const CommandRow& row, const Sample& sample, SampleGenerator&) {
    return check_round_trip(row, sample);
  });
}

TEST(TableProperties, EitherCaseAndBlanksAfterCommasMakeNoDifference) {
  for_every_row(kTrials, [](const CommandRow& row, const Sample& sample, SampleGenerator& random) {
    return check_reading(row, sample, loosened(sample.line, random));
  });
}

TEST(TableProperties, IntegersBesideTheirRangeAreRefused) {
  for_every_row(kTrials, [](const CommandRow& row, const Sample& sample, SampleGenerator&) {
    return check_integers(row, sample);
  });
}

TEST(TableProperties, PulsesBesideTheirRangeAreRefused) {
  for_every_row(
      kTrials, [](const CommandRow& row, const Sample& sample, SampleGenerator&) { return check_pulses(row, sample); });
}

// Each parameter that people see can be given, and has a range or choices.
TEST(TableProperties, ParametersAreThoseOfTheFormat) {
  for (const CommandRow& row : model().commands()) {
    for (const Parameter& parameter : row.parameters) {
      EXPECT_NE(row.format.find(fmt::format("<{}>", parameter.letter)), std::string_view::npos)
          << row.name << ' ' << parameter.letter;
      EXPECT_EQ(parameter.kind == Kind::choice, !parameter.choices.empty()) << row.name << ' ' << parameter.letter;
      const bool number = parameter.kind != Kind::choice && parameter.kind != Kind::text;
      EXPECT_EQ(number, parameter.minimum < parameter.maximum) << row.name << ' ' << parameter.letter;
    }
  }
}

TEST(TableProperties, AWayOfAxis3MovesAxis3) {
  for (const CommandRow& row : model().commands()) {
    EXPECT_EQ(row.third_axis, row.format.find("<z>") != std::string_view::npos) << row.name;
  }
}

TEST(TableProperties, NoOtherRowClaimsALine) {
  for_every_row(kTrialsForOtherRows, [](const CommandRow& row, const Sample& sample, SampleGenerator&) {
    return check_claims(row, sample);
  });
}

}  // namespace
}  // namespace axisgate::shrc203::table_properties_test
