// Tests of every example in the manual, and of every row of the command table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <ostream>
#include <set>

#include "device/shrc203/command/command_table.h"
#include "tests/conformance/verification.h"

namespace axisgate::shrc203::conformance {

// Prints an example for GoogleTest's messages.
void PrintTo(const Transcripts::Example& example, std::ostream* out) { *out << example.entry.place; }

namespace {

using Example = Transcripts::Example;

// Returns a name for the test, "moves_line_3_67_M": GoogleTest accepts only letters, digits and underscores.
std::string test_name(const testing::TestParamInfo<Example>& info) {
  const Example& example = info.param;
  std::string name = example.file.substr(0, example.file.find('.')) + "_line_" +
                     std::to_string(example.block.front().number) + "_" + std::to_string(example.entry.section) + "_" +
                     example.entry.row;
  std::erase_if(name, [](unsigned char c) { return !std::isalnum(c) && c != '_'; });
  return name;
}

std::vector<Example> live_examples() {
  std::vector<Example> live;
  for (const Example& example : all_transcripts().examples) {
    if (!example.entry.offline) live.push_back(example);
  }
  return live;
}

class TableOnTranscript : public testing::TestWithParam<Example> {};
class SimulatorOnTranscript : public testing::TestWithParam<Example> {};

TEST_P(TableOnTranscript, Agrees) {
  const Entry& entry = GetParam().entry;
  const auto complaint = check_by_table(entry);
  EXPECT_FALSE(complaint) << entry.place << ": > " << entry.sent << "\n" << *complaint;
}

TEST_P(SimulatorOnTranscript, Agrees) {
  const Entry& entry = GetParam().entry;
  const auto complaint = check_by_simulator(entry);
  EXPECT_FALSE(complaint) << entry.place << ": > " << entry.sent << "\n" << *complaint;
}

INSTANTIATE_TEST_SUITE_P(Manual, TableOnTranscript, testing::ValuesIn(all_transcripts().examples), test_name);
INSTANTIATE_TEST_SUITE_P(Manual, SimulatorOnTranscript, testing::ValuesIn(live_examples()), test_name);

TEST(Transcripts, AllAreReadable) {
  for (const auto& mistake : all_transcripts().mistakes) ADD_FAILURE() << mistake;
  EXPECT_FALSE(all_transcripts().examples.empty());
}

TEST(Transcripts, EveryRowHasATranscript) {
  std::set<std::string_view> covered;
  for (const auto& example : all_transcripts().examples) covered.insert(example.entry.row);
  for (const CommandRow& row : model().commands()) {
    EXPECT_TRUE(covered.erase(row.name)) << "no transcript for " << row.name << " (manual " << row.section << "))";
  }
  for (const auto name : covered) ADD_FAILURE() << "transcripts for '" << name << "', which the table does not have";
}

TEST(Transcripts, SectionsMatchTheTable) {
  for (const auto& example : all_transcripts().examples) {
    const auto row = std::ranges::find(model().commands(), example.entry.row, &CommandRow::name);
    if (row == model().commands().end()) continue;  // EveryRowHasATranscript reports it
    EXPECT_EQ(example.entry.section, row->section) << example.entry.place;
  }
}

}  // namespace
}  // namespace axisgate::shrc203::conformance
