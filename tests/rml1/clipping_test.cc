// Tests of the cases A to Q of guideline 5-1, computed by hand in clipping/cases.txt.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/rml1/clipping_cases.h"
#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

// Returns the corners of a course. Consecutive pieces in one direction count as one move.
std::vector<std::string> corners(const std::vector<Move>& moves, std::size_t begin) {
  std::vector<std::string> found;
  for (std::size_t index = begin; index < moves.size(); ++index) {
    const jobs::Point way = moves[index].to - moves[index].from;
    const bool last = index + 1 == moves.size();
    const jobs::Point next = last ? jobs::Point{} : moves[index + 1].to - moves[index + 1].from;
    const jobs::Point turn = way * (1 / length(way)) - next * (last ? 0 : 1 / length(next));
    if (last || length(turn) > 1e-9) found.push_back(text(moves[index].to));
  }
  return found;
}

class Clipping : public testing::TestWithParam<Paragraph> {};

TEST_P(Clipping, DrivesWhatWasWorkedOutByHand) {
  const ClippingCase played = play_case(GetParam());
  EXPECT_THAT(corners(played.whole.moves, played.begin), testing::ElementsAreArray(GetParam().all("move")))
      << played.job;
  EXPECT_EQ(text(played.whole.final), GetParam().all("final").at(0)) << played.job;
}

INSTANTIATE_TEST_SUITE_P(Cases, Clipping, testing::ValuesIn(paragraphs("clipping/cases.txt")), [](const auto& one) {
  std::string name;
  const std::vector<std::string> cases = one.param.all("case");
  for (const char c : cases.at(0)) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

// Each case from A to Q must be present.
TEST(Clipping, EveryCaseIsThere) {
  std::string letters;
  for (const Paragraph& one : paragraphs("clipping/cases.txt")) {
    const char letter = one.all("case").at(0).at(0);
    if (letters.find(letter) == std::string::npos) letters += letter;
  }
  EXPECT_EQ(letters, "ABCDEFGHIJKLMNOPQ");
}

}  // namespace
}  // namespace axisgate::rml1
