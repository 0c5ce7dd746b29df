// The cases A to Q of guideline 5-1, worked out by hand in clipping/cases.txt.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/rml1/mill.h"
#include "tests/rml1/paragraphs.h"

namespace axisgate::rml1 {
namespace {

// X 0 to 1000, Y 0 to 1000, Z -1000 to 500.
Profile small_mill() {
  Profile profile = test_profile();
  profile.step_mm = 0.01;
  profile.x_mm = profile.y_mm = 10;
  profile.z_mm = 15;
  profile.default_z1 = -200;
  profile.default_z2 = 300;
  return profile;
}
constexpr Origin kOrigin{0, 0, 5};

std::string text(const Point& p) { return fmt::format("{:g} {:g} {:g}", p.x, p.y, p.z); }

// Pieces in one direction are one move.
std::vector<std::string> corners(const std::vector<Move>& moves, std::size_t begin) {
  std::vector<std::string> found;
  for (std::size_t index = begin; index < moves.size(); ++index) {
    const Point way = moves[index].to - moves[index].from;
    const bool last = index + 1 == moves.size();
    const Point next = last ? Point{} : moves[index + 1].to - moves[index + 1].from;
    const Point turn = way * (1 / length(way)) - next * (last ? 0 : 1 / length(next));
    if (last || length(turn) > 1e-9) found.push_back(text(moves[index].to));
  }
  return found;
}

std::string joined(const Paragraph& one, bool judged) {
  std::string job;
  bool begun = false;
  for (const auto& [mark, words] : one.lines) {
    begun = begun || mark == "begin";
    if (mark == "job" && begun == judged) job += words;
  }
  return job;
}

class Clipping : public testing::TestWithParam<Paragraph> {};

TEST_P(Clipping, DrivesWhatWasWorkedOutByHand) {
  const std::string before = joined(GetParam(), false);
  const std::string job = before + joined(GetParam(), true);
  const std::size_t begin = play(before, small_mill(), kOrigin).moves.size();
  const Played played = play(job, small_mill(), kOrigin);
  EXPECT_THAT(corners(played.moves, begin), testing::ElementsAreArray(GetParam().all("move"))) << job;
  EXPECT_EQ(text(played.final), GetParam().all("final").at(0)) << job;
}

INSTANTIATE_TEST_SUITE_P(Cases, Clipping, testing::ValuesIn(paragraphs("clipping/cases.txt")), [](const auto& one) {
  std::string name;
  const std::vector<std::string> cases = one.param.all("case");
  for (const char c : cases.at(0)) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

// A to Q, each of them.
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
