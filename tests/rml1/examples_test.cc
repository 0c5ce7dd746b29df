// Tests of every example and every error of the guideline, typed by hand in examples/.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <set>
#include <sstream>

#include "device/rml1/language/characters.h"
#include "tests/rml1/mill.h"
#include "tests/rml1/paragraphs.h"

namespace axisgate::rml1 {
namespace {

// Row for the guideline's examples of the parameter reader: they use a command that the guideline lacks (2-5).
constexpr Parameter kInt{true, kIntLowest, kIntHighest, false, false};
constexpr Row kIp[] = {
    {"IP", Operation::ignored, "2-5", Takes::up_to, 4, Coordinates::kept, Tool::kept, {kInt, kInt, kInt, kInt}}};

std::span<const Row> rows_for(const Paragraph& example) {
  return example.all("%").empty() ? std::span<const Row>() : std::span<const Row>(kIp);
}

// Returns the diagnostics as text: "! 2 6" for an error, "~ 3" for anything less severe.
std::vector<std::string> told(const Played& played) {
  std::vector<std::string> lines;
  for (const Diagnostic& one : played.diagnostics) {
    lines.push_back(one.severity == Severity::error ? fmt::format("! {} {}", one.number, one.place.offset)
                                                    : fmt::format("~ {}", one.place.offset));
  }
  return lines;
}

std::vector<int> numbers(const Played& played) {
  std::vector<int> found;
  for (const Diagnostic& one : played.diagnostics) {
    if (one.severity == Severity::error) found.push_back(one.number);
  }
  return found;
}

std::vector<std::string> expected_diagnostics(const Paragraph& example) {
  std::vector<std::string> lines;
  for (const auto& [mark, text] : example.lines) {
    if (mark == "!" || mark == "~") lines.push_back(mark + " " + text);
  }
  return lines;
}

class Examples : public testing::TestWithParam<Paragraph> {};

TEST_P(Examples, AsTheGuidelineSays) {
  const std::string job = unescaped(GetParam().all("<").at(0));
  const Played played = play(job, test_profile(), {}, rows_for(GetParam()));
  EXPECT_THAT(played.commands, testing::ElementsAreArray(GetParam().all(">"))) << GetParam().all("<")[0];
  EXPECT_THAT(told(played), testing::ElementsAreArray(expected_diagnostics(GetParam()))) << GetParam().all("<")[0];
  for (const std::string& same : GetParam().all("=")) {
    const Played other = play(unescaped(same), test_profile(), {}, rows_for(GetParam()));
    EXPECT_EQ(other.commands, played.commands) << same;
    EXPECT_EQ(numbers(other), numbers(played)) << same;
  }
}

INSTANTIATE_TEST_SUITE_P(Guideline, Examples, testing::ValuesIn(paragraphs("examples")), [](const auto& one) {
  std::string name;
  for (const char c : one.param.where) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

TEST(Examples, ThereAreManyOfThem) { EXPECT_GE(paragraphs("examples").size(), 600u); }

// Returns an error of a command's section as text: "@: error 3, parameter 1 too high".
std::string out_of_range(const Row& row, std::size_t index, bool low) {
  return fmt::format("{}: error 3, parameter {} too {}", row.name, index + 1, low ? "low" : "high");
}

std::set<std::string> possible_errors(const Row& row) {
  std::set<std::string> found;
  if (row.takes != Takes::sets || row.count > 1) found.insert(fmt::format("{}: error 2", row.name));
  if (row.takes == Takes::axes) found.insert(fmt::format("{}: error 3", row.name));
  for (std::size_t index = 0; index < row.count; ++index) {
    if (row.parameters[index].lowest_stated) found.insert(out_of_range(row, index, true));
    if (row.parameters[index].highest_stated) found.insert(out_of_range(row, index, false));
  }
  return found;
}

// Returns the text between a command's name and `at`. nullopt if `at` is no longer in the command's list.
std::optional<std::string> list_before(const std::string& job, std::size_t at, const Row& row) {
  std::string list = job.substr(0, at);
  list.erase(0, list.find_last_of(";\r\n") + 1);
  if (!list.starts_with(row.name)) return std::nullopt;
  list.erase(0, row.name.size());
  const bool other = row.takes != Takes::axes && list.find_first_not_of("+-.,0123456789 \t") != std::string::npos;
  return other ? std::nullopt : std::optional(list);
}

std::size_t count_numbers(const std::string& list) {
  std::size_t count = 0;
  char before = ' ';
  for (const char c : list) {
    if (begins_number(c) && !begins_number(before)) ++count;
    before = c;
  }
  return count;
}

// Returns the error of `row` that an example shows; empty if the row's section has no such error.
std::string shown_error(const std::string& job, int number, std::size_t at, const Row& row) {
  const std::optional<std::string> list = list_before(job, at, row);
  if (!list) return "";
  if (row.takes == Takes::axes) return fmt::format("{}: error {}", row.name, number);
  const std::size_t before = count_numbers(*list);
  if (number == 2) {
    const bool apart = list->empty() || !begins_number(list->back());  // otherwise the previous number was cut short
    const bool left = apart && begins_number(job.at(at)) && row.count > 0 && before % row.count == 0;
    const bool shows = row.takes == Takes::sets ? left : before == row.count;
    return shows ? fmt::format("{}: error 2", row.name) : "";
  }
  if (number != 3 || before >= row.count) return "";
  const double value = std::strtod(job.c_str() + at, nullptr);
  const Parameter& parameter = row.parameters[before];
  const bool low = value < parameter.lowest;
  return low || value > parameter.highest ? out_of_range(row, before, low) : "";
}

TEST(Examples, EachErrorOfEachCommandHasOne) {
  std::set<std::string> missing;
  for (const Row& row : guideline_rows()) missing.merge(possible_errors(row));
  for (const Paragraph& example : paragraphs("examples")) {
    const std::string job = unescaped(example.all("<").at(0));
    for (const std::string& error : example.all("!")) {
      std::istringstream words(error);
      int number = 0;
      std::size_t offset = 0;
      words >> number >> offset;
      for (const Row& row : guideline_rows()) missing.erase(shown_error(job, number, offset, row));
    }
  }
  EXPECT_THAT(missing, testing::IsEmpty());
}

}  // namespace
}  // namespace axisgate::rml1
