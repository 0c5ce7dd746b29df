#include "device/rml1/language/diagnostic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;

template <class Text>
void add(Diagnostics& diagnostics, Severity severity, const jobs::Place& place, Text text) {
  if (severity == Severity::error) return diagnostics.error(1, place, "2-5", text);
  if (severity == Severity::note) return diagnostics.note(place, "2-5", text);
  diagnostics.warn(Warning::out_of_range, place, "2-5", text);
}

void add(Diagnostics& diagnostics, Severity severity, std::uint64_t offset) {
  add(diagnostics, severity, jobs::Place{offset, 1, offset + 1}, [] { return "text"; });
}

TEST(Diagnostics, KeepWhatTheyAreTold) {
  Diagnostics diagnostics;
  diagnostics.error(3, jobs::Place{7, 2, 3}, "3-1", [] { return std::string("too much"); });
  ASSERT_EQ(diagnostics.kept().size(), 1u);
  const Diagnostic& one = diagnostics.kept()[0];
  EXPECT_EQ(one.number, 3);
  EXPECT_EQ(one.severity, Severity::error);
  EXPECT_EQ(one.place, (jobs::Place{7, 2, 3}));
  EXPECT_EQ(one.section, "3-1");
  EXPECT_EQ(one.text, "too much");
}

TEST(Diagnostics, KeepTheFirstTenOfAKindAndCountAll) {
  Diagnostics diagnostics;
  for (std::uint64_t offset = 0; offset < 250; ++offset) add(diagnostics, Severity::warning, offset);
  ASSERT_EQ(diagnostics.kept().size(), 10u);
  for (std::uint64_t offset = 0; offset < 10; ++offset) EXPECT_EQ(diagnostics.kept()[offset].place.offset, offset);
  EXPECT_EQ(diagnostics.count(Severity::warning), 250u);
  EXPECT_EQ(diagnostics.count(Severity::error), 0u);
  EXPECT_EQ(diagnostics.omitted_count(), 240u);
}

TEST(Diagnostics, OmitNothingUpToTen) {
  Diagnostics diagnostics;
  for (std::uint64_t offset = 0; offset < 10; ++offset) add(diagnostics, Severity::note, offset);
  EXPECT_EQ(diagnostics.omitted_count(), 0u);
  EXPECT_THAT(diagnostics.omitted(), testing::IsEmpty());
}

template <int kind>
void add_kind(Diagnostics& diagnostics, std::uint64_t times, Severity severity = Severity::warning) {
  for (std::uint64_t offset = 0; offset < times; ++offset) {
    add(diagnostics, severity, jobs::Place{offset, 1 + offset, 1}, [] { return std::to_string(kind); });
  }
}

TEST(Diagnostics, NoKindTakesThePlaceOfAnother) {
  Diagnostics diagnostics;
  add_kind<1>(diagnostics, 300);
  add_kind<2>(diagnostics, 1, Severity::error);
  add_kind<3>(diagnostics, 12);
  ASSERT_EQ(diagnostics.kept().size(), 21u);
  EXPECT_EQ(diagnostics.kept()[9].text, "1");
  EXPECT_EQ(diagnostics.kept()[10].text, "2");
  EXPECT_EQ(diagnostics.kept()[20].text, "3");
}

TEST(Diagnostics, SayWhatTheyOmit) {
  Diagnostics diagnostics;
  add_kind<1>(diagnostics, 300);
  add_kind<2>(diagnostics, 10);
  const auto omitted = diagnostics.omitted();
  ASSERT_EQ(omitted.size(), 1u);
  EXPECT_EQ(omitted[0].first.text, "1");
  EXPECT_EQ(omitted[0].first.place.line, 1u);
  EXPECT_EQ(omitted[0].count, 290u);
  EXPECT_EQ(omitted[0].last.line, 300u);
}

TEST(Diagnostics, MakeNoTextOfWhatIsNotKept) {
  for (const Severity severity : {Severity::note, Severity::warning, Severity::error}) {
    Diagnostics diagnostics;
    int made = 0;
    for (int index = 0; index < 1000; ++index) {
      add(diagnostics, severity, jobs::Place(), [&] {
        ++made;
        return "text";
      });
    }
    EXPECT_EQ(made, 10) << name(severity);
  }
}

TEST(Diagnostics, AreOrderedByPlaceAndTheWholeJobComesFirst) {
  Diagnostics diagnostics;
  const auto add_text = [&](int number, std::uint64_t offset, const char* text) {
    diagnostics.error(number, jobs::Place{offset, 1, offset + 1}, "2-3", [text] { return text; });
  };
  add_text(1, 5, "third"), add_text(1, 0, "second"), add_text(0, 0, "first"), add_text(2, 5, "fourth");
  std::vector<std::string> texts;
  for (const Diagnostic& one : diagnostics.in_order()) texts.push_back(one.text);
  EXPECT_THAT(texts, ElementsAre("first", "second", "third", "fourth"));
}

TEST(Diagnostics, HaveNamesOfSeverities) {
  EXPECT_EQ(name(Severity::note), "note");
  EXPECT_EQ(name(Severity::warning), "warning");
  EXPECT_EQ(name(Severity::error), "error");
}

}  // namespace
}  // namespace axisgate::rml1
