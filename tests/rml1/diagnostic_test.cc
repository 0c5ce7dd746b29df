#include "device/rml1/diagnostic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;

void add(Diagnostics& diagnostics, Severity severity, std::uint64_t offset) {
  diagnostics.add(0, severity, Place{offset, 1, offset + 1}, "2-5", [] { return "text"; });
}

std::uint64_t count(const Diagnostics& diagnostics, Severity severity) {
  std::uint64_t found = 0;
  for (const Diagnostic& one : diagnostics.kept()) found += one.severity == severity ? 1 : 0;
  return found;
}

TEST(Diagnostics, KeepWhatTheyAreTold) {
  Diagnostics diagnostics;
  diagnostics.error(3, Place{7, 2, 3}, "3-1", [] { return std::string("too much"); });
  ASSERT_EQ(diagnostics.kept().size(), 1u);
  const Diagnostic& one = diagnostics.kept()[0];
  EXPECT_EQ(one.number, 3);
  EXPECT_EQ(one.severity, Severity::error);
  EXPECT_EQ(one.place, (Place{7, 2, 3}));
  EXPECT_EQ(one.section, "3-1");
  EXPECT_EQ(one.text, "too much");
}

TEST(Diagnostics, KeepAHundredAndCountAll) {
  Diagnostics diagnostics;
  for (std::uint64_t offset = 0; offset < 250; ++offset) add(diagnostics, Severity::warning, offset);
  ASSERT_EQ(diagnostics.kept().size(), 100u);
  for (std::uint64_t offset = 0; offset < 100; ++offset) EXPECT_EQ(diagnostics.kept()[offset].place.offset, offset);
  EXPECT_EQ(diagnostics.count(Severity::warning), 250u);
  EXPECT_EQ(diagnostics.count(Severity::error), 0u);
  EXPECT_EQ(diagnostics.omitted(), 150u);
}

TEST(Diagnostics, OmitNothingUpToAHundred) {
  Diagnostics diagnostics;
  for (std::uint64_t offset = 0; offset < 100; ++offset) add(diagnostics, Severity::note, offset);
  EXPECT_EQ(diagnostics.omitted(), 0u);
}

// The last that is none, so that what a job begins with stays.
TEST(Diagnostics, AnErrorTakesThePlaceOfTheLastThatIsNone) {
  Diagnostics diagnostics;
  for (std::uint64_t offset = 0; offset < 98; ++offset) add(diagnostics, Severity::note, offset);
  add(diagnostics, Severity::warning, 98);
  add(diagnostics, Severity::error, 99);
  add(diagnostics, Severity::error, 100);
  ASSERT_EQ(diagnostics.kept().size(), 100u);
  EXPECT_EQ(diagnostics.kept()[97].place.offset, 97u);
  EXPECT_EQ(diagnostics.kept()[98].place.offset, 99u);
  EXPECT_EQ(diagnostics.kept()[99].place.offset, 100u);
  EXPECT_EQ(diagnostics.count(Severity::warning), 1u);
  EXPECT_EQ(diagnostics.omitted(), 1u);
}

TEST(Diagnostics, NothingTakesThePlaceOfAnError) {
  Diagnostics diagnostics;
  for (std::uint64_t offset = 0; offset < 150; ++offset) add(diagnostics, Severity::warning, offset);
  for (std::uint64_t offset = 150; offset < 400; ++offset) add(diagnostics, Severity::error, offset);
  add(diagnostics, Severity::warning, 400);
  EXPECT_EQ(count(diagnostics, Severity::error), 100u);
  for (std::uint64_t index = 0; index < 100; ++index) {
    EXPECT_EQ(diagnostics.kept()[index].place.offset, 150 + index);
  }
  EXPECT_EQ(diagnostics.omitted(), 301u);
}

TEST(Diagnostics, MakeNoTextOfWhatIsNotKept) {
  for (const Severity severity : {Severity::note, Severity::warning, Severity::error}) {
    Diagnostics diagnostics;
    int made = 0;
    for (int index = 0; index < 1000; ++index) {
      diagnostics.add(1, severity, {}, "2-3", [&] {
        ++made;
        return "text";
      });
    }
    EXPECT_EQ(made, 100) << name(severity);
  }
}

template <int kind>
void add_kind(Diagnostics& diagnostics, int times) {
  for (int time = 0; time < times; ++time) {
    diagnostics.add(0, Severity::warning, {}, "2-5", [] { return std::to_string(kind); });
  }
}

TEST(Diagnostics, TheFirstOfItsKindTakesThePlaceOfTheLastOfMany) {
  Diagnostics diagnostics;
  add_kind<1>(diagnostics, 89);
  add_kind<2>(diagnostics, 11);
  add_kind<3>(diagnostics, 5);
  ASSERT_EQ(diagnostics.kept().size(), 100u);
  EXPECT_EQ(diagnostics.kept()[98].text, "2");
  EXPECT_EQ(diagnostics.kept()[99].text, "3");
  // Ten of the second are not many.
  add_kind<4>(diagnostics, 1);
  EXPECT_EQ(diagnostics.kept()[87].text, "1");
  EXPECT_EQ(diagnostics.kept()[88].text, "2");
  EXPECT_EQ(diagnostics.kept()[99].text, "4");
  EXPECT_EQ(diagnostics.omitted(), 6u);
}

TEST(Diagnostics, WhatStandsThereTenTimesIsNotMany) {
  Diagnostics diagnostics;
  add_kind<0>(diagnostics, 10), add_kind<1>(diagnostics, 10), add_kind<2>(diagnostics, 10);
  add_kind<3>(diagnostics, 10), add_kind<4>(diagnostics, 10), add_kind<5>(diagnostics, 10);
  add_kind<6>(diagnostics, 10), add_kind<7>(diagnostics, 10), add_kind<8>(diagnostics, 10);
  add_kind<9>(diagnostics, 10);
  add_kind<10>(diagnostics, 1);
  EXPECT_EQ(diagnostics.kept().back().text, "9");
  EXPECT_EQ(diagnostics.omitted(), 1u);
}

TEST(Diagnostics, HaveNamesOfSeverities) {
  EXPECT_EQ(name(Severity::note), "note");
  EXPECT_EQ(name(Severity::warning), "warning");
  EXPECT_EQ(name(Severity::error), "error");
}

}  // namespace
}  // namespace axisgate::rml1
