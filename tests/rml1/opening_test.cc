// Tests of the kind of a file by its first bytes: a job, or one line that names the other kind.
#include "device/rml1/check/opening.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using namespace std::string_literals;
using testing::ElementsAre;
using testing::HasSubstr;

struct Other {
  std::string bytes, what;
};

std::string doubled(const std::string& text, bool zero_first) {
  std::string wide;
  for (const char c : text) wide += zero_first ? "\0"s + c : c + "\0"s;
  return wide;
}

// File beginnings by the formats' specifications. A Gerber file begins with a comment or an extended command.
const Other kOthers[] = {
    {"%PDF-1.7\n%\xE2\xE3\n", "a PDF document"},
    {"\x89PNG\r\n\x1A\n\0\0"s, "a PNG picture"},
    {"\xFF\xD8\xFF\xE0\0\x10JFIF"s, "a JPEG picture"},
    {"GIF89a\x10\0"s, "a GIF picture"},
    {"BM\x36\x84\x03\0\0\0"s, "a BMP picture"},
    {"II*\0\x08\0"s, "a TIFF picture"},
    {"PK\x03\x04\x14\0"s, "a ZIP archive"},
    {"\xFF\xFE" + doubled("PU;", false), "a text in UTF-16"},
    {doubled("PA;PU0,0;PD100,0;", false), "a text in UTF-16"},
    {doubled("PA;PU0,0;PD100,0;", true), "a text in UTF-16"},
    {"%FSLAX24Y24*%\n%MOMM*%\n", "a Gerber file"},
    {"%TF.FileFunction,Copper*%\n", "a Gerber file"},
    {"G04 made by a program*\nD10*\n", "a Gerber file"},
    {"solid part\n facet normal 0 0 1\n", "a model in STL"},
    {"made by a program" + std::string(63, '\0') + "\x0C\0\0\0\0\0\x80\x3F"s, "a binary file, e.g. a model in STL"},
    {"<!DOCTYPE html>\n<html>", "an HTML page"},
    {"\xEF\xBB\xBF \n<html>", "an HTML page"},
    {"<?xml version='1.0'?><svg>", "an XML file"},
    {"<svg width='1'>", "an SVG picture"},
};

TEST(OtherFile, IsOneErrorWhateverFollows) {
  for (const auto& [bytes, what] : kOthers) {
    for (const std::string& rest : {""s, std::string(1000, '\n') + "Q;Q;Q;"}) {
      const auto check = checked(bytes + rest, test_profile());
      EXPECT_TRUE(check->is_other_file()) << what;
      ASSERT_THAT(told(check->diagnostics().kept()), ElementsAre("error 0 at 0")) << what;
      EXPECT_EQ(check->diagnostics().kept()[0].text, "this is " + what + ", not a job in RML-1");
    }
  }
}

TEST(OtherFile, IsTheSameHoweverItsBytesCome) {
  for (const auto& [bytes, what] : kOthers) {
    Opening opening;
    for (const char c : bytes) opening.take({&c, 1});
    opening.finish();
    EXPECT_EQ(opening.what(), what);
  }
}

TEST(OtherFile, IsNotWhatMayBeAJob) {
  for (const std::string& job : {"PD;PU;"s, "\0\0;;^IN;"s, "F4;\xE9"s, "@-9,9;PD;"s, "G;"s, "I1,1"s, "M9,9"s}) {
    EXPECT_FALSE(checked(job, test_profile())->is_other_file()) << job;
  }
}

// Each byte of the mark would otherwise be an error 1 (1-1). The job after the mark is read.
TEST(ByteOrderMark, IsOneError) {
  const auto check = checked("\xEF\xBB\xBF@-9,9;PD;PU;\nQ;", test_profile());
  EXPECT_THAT(told(check->diagnostics().kept()), ElementsAre("error 1 at 0", "error 1 at 16"));
  EXPECT_THAT(check->diagnostics().kept()[0].text, HasSubstr("byte order mark"));
  EXPECT_EQ(check->diagnostics().kept()[1].place, (jobs::Place{16, 2, 1}));
  EXPECT_EQ(check->summary().commands, 3u);
}

TEST(NoCommand, IsAnError) {
  for (const std::string& job : {""s, "\n"s, ";;"s, std::string(100'000, '\0'), "\x04"s}) {
    const auto check = checked(job, test_profile());
    EXPECT_THAT(told(check->diagnostics().kept()), ElementsAre("error 0 at 0")) << job.size();
  }
  EXPECT_THAT(checked("", test_profile())->diagnostics().kept()[0].text, HasSubstr("the file is empty"));
  EXPECT_THAT(checked(std::string(600, '\0'), test_profile())->diagnostics().kept()[0].text,
              HasSubstr("600 bytes without a command"));
  EXPECT_THAT(told(checked("F5;", test_profile())->diagnostics().kept()), testing::IsEmpty());
}

TEST(GCode, IsRefusedWithoutAnythingElse) {
  for (const char* job : {"\n %\nO1000\n", "\n G0 X1 Y2\n", "\n N10 G21\n", "\n g\t21\n", "\n (comment)\n"}) {
    const auto check = checked(job, test_profile());
    EXPECT_TRUE(check->is_other_file()) << job;
    EXPECT_THAT(told(check->diagnostics().kept()), ElementsAre("error 0 at 2")) << job;
    EXPECT_EQ(check->diagnostics().kept()[0].place, (jobs::Place{2, 2, 2})) << job;
    EXPECT_EQ(check->summary().commands, 0u) << job;
  }
}

TEST(GCode, IsToldBehindCommentsAndWordsOfBoth) {
  struct Case {
    const char* job;
    jobs::Place place;
  };
  for (const auto& [job, place] : {Case{"; made by a program: PU, PD\n;\nG21\n", {30, 3, 1}},
                                   {"T1 M6\r\nS1000M3 ; on\r\nG0 X1\r\n", {21, 3, 1}},
                                   {"M05\n (off)\n", {5, 2, 2}},
                                   {"X10.5 Y-2 F100 G1", {15, 1, 16}}}) {
    const auto check = checked(job, test_profile());
    EXPECT_TRUE(check->is_other_file()) << job;
    EXPECT_EQ(check->diagnostics().kept().at(0).place, place) << job;
  }
}

TEST(GCode, IsNotToldWithoutAWordOfItsOwn) {
  for (const char* job : {"; G0 X1\nPU1,1;\nG0\n", "F4;G0\nPU1,1;G0\n", "M3\nT1\n", "; G0\n", "Z1 Y.X\nG0\n"}) {
    EXPECT_FALSE(checked(job, test_profile())->is_other_file()) << job;
  }
}

// The text kept until the kind is known has a limit.
TEST(GCode, IsSoughtIn64KiB) {
  const std::string comment = ";" + std::string(65532, 'a') + "\n";
  EXPECT_TRUE(checked(comment + "G0", test_profile())->is_other_file());
  EXPECT_FALSE(checked(";" + comment + "G0", test_profile())->is_other_file());
}

TEST(GCode, IsNotWhatOnlyBeginsLikeIt) {
  for (const char* job : {"GX1;", "N;PD;", "PD;G0;", "\x1B.K%", "!MC1;N10"}) {
    EXPECT_FALSE(checked(job, test_profile())->is_other_file()) << job;
  }
}

}  // namespace
}  // namespace axisgate::rml1
