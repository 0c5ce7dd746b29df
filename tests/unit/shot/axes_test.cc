#include "device/shot/command/axes.h"

#include <gmock/gmock.h>

#include <string>

namespace axisgate::shot::axes_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const AxisSet k1 = AxisSet::of(1);
const AxisSet k2 = AxisSet::of(2);
const AxisSet k3 = AxisSet::of(3);
const AxisSet k12 = k1 | k2;
const AxisSet k13 = k1 | k3;
const AxisSet k23 = k2 | k3;
const AxisSet k123 = k1 | k2 | k3;

TEST(AxisSet, IsASet) {
  EXPECT_THAT(AxisSet().list(), IsEmpty());
  EXPECT_TRUE(AxisSet().empty());
  EXPECT_THAT(k13.list(), ElementsAre(1, 3));
  EXPECT_EQ(kLetteredAxes, k123);
  EXPECT_EQ(k123 - k2, k13);
  EXPECT_EQ(k12 & k23, k2);
  EXPECT_EQ(k23.lowest(), 2);
  EXPECT_EQ(AxisSet().lowest(), 0);
  EXPECT_EQ(k13.count(), 2);
  EXPECT_TRUE(k13.has(3));
  EXPECT_FALSE(k13.has(2));
  EXPECT_TRUE(k123.contains(k13));
  EXPECT_FALSE(k13.contains(k12));
  EXPECT_TRUE(k13.touches(k12));
  EXPECT_FALSE(k1.touches(k23));
}

TEST(AxisSet, AddsAndRemoves) {
  AxisSet axes;
  axes.add(3);
  axes.add(1);
  axes.add(3);
  EXPECT_EQ(axes, k13);
  axes.remove(3);
  axes.remove(2);
  EXPECT_EQ(axes, k1);
}

TEST(AxisSet, IsWrittenForPeople) {
  EXPECT_EQ(to_string(AxisSet()), "no axis");
  EXPECT_EQ(to_string(k2), "axis 2");
  EXPECT_EQ(to_string(k13), "axes 1 and 3");
  EXPECT_EQ(to_string(k123), "axes 1, 2 and 3");
}

// Manual 10) ?:P and all other commands with a parameter `a`.
TEST(CommandLetter, IsTheOneOfTheManual) {
  EXPECT_EQ(command_letter(k1), '1');
  EXPECT_EQ(command_letter(k2), '2');
  EXPECT_EQ(command_letter(k3), '3');
  EXPECT_EQ(command_letter(k12), 'A');
  EXPECT_EQ(command_letter(k13), 'B');
  EXPECT_EQ(command_letter(k23), 'C');
  EXPECT_EQ(command_letter(k123), 'D');
}

// The controllers of the family have letters for sets of three axes at most.
TEST(CommandLetter, IsNoneForOtherSets) {
  for (unsigned bits = 0; bits < 256; ++bits) {
    const AxisSet axes = AxisSet::in(use::Scope::of_axes(bits));
    const bool named = axes.count() == 1 || (bits != 0 && bits < 8);
    EXPECT_EQ(command_letter(axes).has_value(), named) << to_string(axes);
  }
}

TEST(CommandLetter, IsReadBack) {
  EXPECT_EQ(from_command_letter('1', k123), k1);
  EXPECT_EQ(from_command_letter('2', k123), k2);
  EXPECT_EQ(from_command_letter('3', k123), k3);
  EXPECT_EQ(from_command_letter('A', k123), k12);
  EXPECT_EQ(from_command_letter('B', k123), k13);
  EXPECT_EQ(from_command_letter('C', k123), k23);
  EXPECT_EQ(from_command_letter('D', k12), k123);
}

TEST(CommandLetter, WMeansAllControllableAxes) {
  EXPECT_EQ(from_command_letter('W', k123), k123);
  EXPECT_EQ(from_command_letter('W', k12), k12);
}

// Manual 4) Q: and 6) SRQ:, field s.
TEST(StatusLetter, HasItsOwnAlphabet) {
  EXPECT_EQ(from_status_letter('1'), k1);
  EXPECT_EQ(from_status_letter('2'), k2);
  EXPECT_EQ(from_status_letter('3'), k3);
  EXPECT_EQ(from_status_letter('C'), k12);
  EXPECT_EQ(from_status_letter('D'), k13);
  EXPECT_EQ(from_status_letter('E'), k23);
  EXPECT_EQ(from_status_letter('W'), k123);
}

// Manual 44) ?:AXIS.
TEST(AxisSetting, HasItsOwnAlphabet) {
  EXPECT_EQ(from_axis_setting("0"), k1);
  EXPECT_EQ(from_axis_setting("1"), k2);
  EXPECT_EQ(from_axis_setting("2"), k3);
  EXPECT_EQ(from_axis_setting("3"), k12);
  EXPECT_EQ(from_axis_setting("4"), k13);
  EXPECT_EQ(from_axis_setting("5"), k23);
  EXPECT_EQ(from_axis_setting("6"), k123);
}

TEST(Alphabets, TakeNothingElse) {
  const std::string command_letters = "12345678ABCDW";  // a digit is the number of the axis
  const std::string status_letters = "123CDEW";
  const std::string settings = "0123456";
  for (int byte = 0; byte < 256; ++byte) {
    const char letter = static_cast<char>(byte);
    const auto belongs = [&](const std::string& alphabet) { return alphabet.find(letter) != std::string::npos; };
    EXPECT_EQ(from_command_letter(letter, k123).has_value(), belongs(command_letters)) << byte;
    EXPECT_EQ(from_status_letter(letter).has_value(), belongs(status_letters)) << byte;
    EXPECT_EQ(from_axis_setting(std::string(1, letter)).has_value(), belongs(settings)) << byte;
  }
  EXPECT_FALSE(from_axis_setting(""));
  EXPECT_FALSE(from_axis_setting("06"));
}

}  // namespace
}  // namespace axisgate::shot::axes_test
