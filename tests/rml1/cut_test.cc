// Tests of the places at which a job is cut into writes, and of parts that cannot be cut.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "device/rml1/sending/longest_piece.h"
#include "tests/rml1/pieces.h"

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;

TEST(Cut, IsBehindACommandAndItsDelimiters) {
  EXPECT_THAT(pieces("PU;PA1,2;\r\nPD 3 4;\n;Z1,2,3\nV 5"),
              ElementsAre("PU;", "PA1,2;\r\n", "PD 3 4;\n;", "Z1,2,3\n", "V 5"));
}

// "^" waits for the command that it calls, despite any delimiters in between (guideline 1-2).
TEST(Cut, DoesNotPartACircumflexFromItsCommand) {
  EXPECT_THAT(pieces("^;\nPA;^ PD1,1;PU;"), ElementsAre("^;\nPA;", "^ PD1,1;", "PU;"));
}

TEST(Cut, OfALongListIsBehindASet) {
  EXPECT_THAT(pieces("PD10,20,30,40,50,60;PU;", 8), ElementsAre("PD10,20,", "30,40,", "50,60;", "PU;"));
  EXPECT_THAT(pieces("Z10,20,30,40,50,60;", 8), ElementsAre("Z10,20,30,", "40,50,60;"));
  EXPECT_THAT(pieces("^PD10,20,30,40;", 8), ElementsAre("^PD10,20,", "30,40;"));
  EXPECT_THAT(pieces("!ZE X10Y20:Z30;PU;", 8), ElementsAre("!ZE X10Y20:Z30;", "PU;")) << "it has no sets";
}

// Upper and lower case are equal, and separators of commands and numbers may be left out (guideline 2-2, 2-3).
TEST(Cut, OfAListHoweverItIsWritten) {
  EXPECT_THAT(pieces("pd10,20,30,40,50,60;pu;", 8), ElementsAre("pd10,20,", "30,40,", "50,60;", "pu;"));
  EXPECT_THAT(pieces("M0,0D10,20,30,40,50,60;", 8), ElementsAre("M0,0D10,20,", "30,40,", "50,60;"));
  EXPECT_THAT(pieces("Z1,2,3PD10,20,30,40;", 8), ElementsAre("Z1,2,3PD10,20,", "30,40;"));
  EXPECT_THAT(pieces("PD10 20,30 40,50,60;", 8), ElementsAre("PD10 20,", "30 40,", "50,60;"));
  EXPECT_THAT(pieces("PD1-2,3,4,5,6,7,8;", 8), ElementsAre("PD1-2,3,4,5,6,7,8;")) << "what makes a set is not known";
}

// A job may end with a page of line feeds, which some programs write.
TEST(Cut, OfManyDelimitersIsBehindTheWindow) {
  EXPECT_THAT(pieces("\n;  PU;\n\n\n\n\n\n\nPD1,1;", 4), ElementsAre("\n;  ", "PU;\n", "\n\n\n\n", "\n\n", "PD1,1;"));
  EXPECT_THAT(pieces("^;;;;;;PA;PU;", 4), ElementsAre("^;;;;;;PA;", "PU;")) << "the circumflex waits for its command";
}

// A list may be as long as the job. This would take minutes if each cut read the list to its end.
TEST(Cut, OfAListOfAMillionNumbers) {
  std::string job = "PD";
  for (int i = 0; i < 500'000; ++i) job += "10,20,";
  job.back() = ';';
  const auto all = pieces(job);
  EXPECT_EQ(all.size(), 50'000u) << "ten sets of six bytes fit the window";
  EXPECT_EQ(all.front(), "PD10,20,10,20,10,20,10,20,10,20,10,20,10,20,10,20,10,20,10,20,");
  EXPECT_EQ(all.back().back(), ';');
}

jobs::Piece longest_of(const std::string& job) {
  LongestPiece pieces;
  for (const char c : job) pieces.take({&c, 1});
  return pieces.longest();
}

TEST(ALongestPiece, IsACommandOrASetOfAList) {
  EXPECT_EQ(longest_of("").bytes, 0u);
  EXPECT_EQ(longest_of("PU;PA1,2;\nPD1,1;").bytes, 6u);
  EXPECT_EQ(longest_of("PD10,20,30,40,50,60;").bytes, 8u);
  EXPECT_EQ(longest_of("!ZE X10Y20:Z30;PU;").bytes, 15u);
  EXPECT_EQ(longest_of("PU;" + std::string(100, '\n') + "PU;").bytes, 3u);
}

TEST(ALongestPiece, HasThePlaceWhereItBegins) {
  const auto piece = longest_of("PU;\nPU; PA" + std::string(50, ' ') + "1,2;PD1,1;");
  EXPECT_EQ(piece.bytes, 56u);
  EXPECT_EQ(piece.begin, (jobs::Place{8, 2, 5}));
}

}  // namespace
}  // namespace axisgate::rml1
