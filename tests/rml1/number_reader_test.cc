// Tests of one parameter (guideline 2-3, 2-5).
#include "device/rml1/language/number_reader.h"

#include <gtest/gtest.h>

#include <string>

namespace axisgate::rml1 {
namespace {

// Reads a number and returns the rest of the text.
std::string read(NumberReader& reader, const std::string& text) {
  EXPECT_TRUE(begins_number(text.at(0)));
  reader.begin(text[0]);
  std::size_t at = 1;
  while (at < text.size() && reader.take(text[at])) ++at;
  return text.substr(at);
}

double value(const std::string& text) {
  NumberReader reader;
  EXPECT_EQ(read(reader, text), "") << text;
  return reader.value();
}

std::string rest(const std::string& text) {
  NumberReader reader;
  return read(reader, text);
}

TEST(NumberReader, ReadsSignsDigitsAndAPoint) {
  EXPECT_EQ(value("0"), 0);
  EXPECT_EQ(value("5000"), 5000);
  EXPECT_EQ(value("+5000"), 5000);
  EXPECT_EQ(value("-5000"), -5000);
  EXPECT_EQ(value("0.5"), 0.5);
  EXPECT_EQ(value("-162.6"), -162.6);
  EXPECT_EQ(value(".100"), 0.1);
  EXPECT_EQ(value("-.25"), -0.25);
  EXPECT_EQ(value("100."), 100);
  EXPECT_EQ(value("007"), 7);
}

TEST(NumberReader, EndsBeforeWhatItCannotTake) {
  EXPECT_EQ(rest("100++100"), "++100");
  EXPECT_EQ(rest("100..100"), ".100");
  EXPECT_EQ(rest(".100.0"), ".0");
  EXPECT_EQ(rest("100-5"), "-5");
  EXPECT_EQ(rest("1e5"), "e5");
  EXPECT_EQ(rest("1 2"), " 2");
  EXPECT_EQ(rest("--1"), "-1");
}

TEST(NumberReader, KnowsWhatIsNoNumber) {
  NumberReader reader;
  for (const std::string text : {"-", "+"}) {
    read(reader, text);
    EXPECT_TRUE(reader.sign_alone()) << text;
    EXPECT_FALSE(reader.point_alone()) << text;
  }
  for (const std::string text : {".", "-.", "+."}) {
    read(reader, text);
    EXPECT_FALSE(reader.sign_alone()) << text;
    EXPECT_TRUE(reader.point_alone()) << text;
    EXPECT_EQ(reader.value(), 0) << text;
  }
  read(reader, "0");
  EXPECT_FALSE(reader.sign_alone());
  EXPECT_FALSE(reader.point_alone());
}

TEST(NumberReader, TellsWhetherAPointWasWritten) {
  NumberReader reader;
  read(reader, "1");
  EXPECT_FALSE(reader.has_point());
  read(reader, "1.");
  EXPECT_TRUE(reader.has_point());
}

TEST(NumberReader, BeginsAnew) {
  NumberReader reader;
  read(reader, "-1.5");
  read(reader, "2");
  EXPECT_EQ(reader.value(), 2);
}

TEST(NumberReader, TakesAnyNumberOfDigits) {
  EXPECT_EQ(value(std::string(100'000, '0') + "8388607"), 8388607);
  EXPECT_EQ(value("8388607." + std::string(100'000, '0')), 8388607);
  EXPECT_NEAR(value("0.1" + std::string(100'000, '3')), 0.1333333333333333, 1e-15);
  EXPECT_NEAR(value("12345678901234567890"), 12345678901234567890.0, 1e4);
  EXPECT_GT(value("1" + std::string(100'000, '0')), 1e100);
  EXPECT_LT(value("-" + std::string(100'000, '9') + ".9"), -1e100);
  EXPECT_EQ(value("1" + std::string(20, '0') + ".5"), 1e20);
  EXPECT_NEAR(value("." + std::string(30, '0') + "9"), 0, 1e-17);
}

TEST(NumberReader, BeginsOnlyWithItsOwnBytes) {
  int count = 0;
  for (int code = 0; code < 256; ++code) count += begins_number(static_cast<char>(code)) ? 1 : 0;
  EXPECT_EQ(count, 13);
  for (const char c : std::string("0123456789+-.")) EXPECT_TRUE(begins_number(c));
}

}  // namespace
}  // namespace axisgate::rml1
