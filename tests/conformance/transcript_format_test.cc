// Tests of the format's rules, so that a typing mistake in a transcript is an error, not a skipped check.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/conformance/transcript.h"

namespace axisgate::shrc203::conformance {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::StartsWith;

constexpr std::string_view kWhole =
    "# words\n"
    "\n"
    "[5 Q:S]\n"
    "source: parameters c, s, r\n"
    "device: axis_setting=3\n"
    "# more words\n"
    "setup: M:A+P100-P200 -> OK\n"
    "setup: G:A -> OK\n"
    "wait: ready\n"
    "> Q:SPC\n"
    "= u=P c=C\n"
    "< P+100,P-200,0\n"
    "fields: P+100 | P-200 | 0\n"
    "after: 1\n"
    "after: 2\n";

std::string mistake_in(std::string_view text) {
  const auto blocks = split_blocks(text);
  if (blocks.size() != 1) return "not one block";
  const auto entry = parse_entry("a.transcript", blocks.front());
  return entry ? "" : entry.error();
}

std::string mistake_with(std::string_view right, std::string_view wrong) {
  std::string text(kWhole);
  text.replace(text.find(right), right.size(), wrong);
  return mistake_in(text);
}

TEST(TranscriptFormat, ReadsEveryLine) {
  const auto entry = parse_entry("a.transcript", split_blocks(kWhole).front());
  ASSERT_TRUE(entry) << entry.error();
  EXPECT_EQ(entry->place, "a.transcript:3");
  EXPECT_EQ(entry->section, 5);
  EXPECT_EQ(entry->row, "Q:S");
  EXPECT_EQ(entry->source, "parameters c, s, r");
  EXPECT_FALSE(entry->offline);
  EXPECT_THAT(entry->device, ElementsAre(Pair("axis_setting", "3")));
  ASSERT_EQ(entry->setup.size(), 2u);
  EXPECT_EQ(entry->setup[0].line, "M:A+P100-P200");
  EXPECT_EQ(entry->setup[1].reply, "OK");
  EXPECT_TRUE(entry->wait_until_ready);
  EXPECT_EQ(entry->sent, "Q:SPC");
  EXPECT_THAT(entry->meaning, ElementsAre(Pair("u", "P"), Pair("c", "C")));
  EXPECT_EQ(entry->reply, "P+100,P-200,0");
  EXPECT_THAT(entry->fields, ElementsAre("P+100", "P-200", "0"));
  EXPECT_THAT(entry->completions, ElementsAre("1", "2"));
}

TEST(TranscriptFormat, NamesFileAndLineOfAMistake) {
  EXPECT_THAT(mistake_with("[5 Q:S]", "[5Q:S]"), StartsWith("a.transcript:3: "));
  EXPECT_THAT(mistake_with("[5 Q:S]", "[x Q:S]"), StartsWith("a.transcript:3: "));
  EXPECT_THAT(mistake_with("source: ", "sauce: "), StartsWith("a.transcript:4: "));
  EXPECT_THAT(mistake_with("axis_setting=3", "axis_setting"), StartsWith("a.transcript:"));
  EXPECT_THAT(mistake_with("setup: G:A", "setup:G:A"), StartsWith("a.transcript:8: "));
  EXPECT_THAT(mistake_with("wait: ready", "wait: quiet"), HasSubstr("quiet"));
  EXPECT_THAT(mistake_with("after: 1\n", "after: 1 \n"), HasSubstr("line 14"));
}

TEST(TranscriptFormat, RefusesLinesThatAreMissingOrOutOfOrder) {
  EXPECT_THAT(mistake_with("> Q:SPC\n", ""), HasSubstr("'> ...' is due"));
  EXPECT_THAT(mistake_with("= u=P c=C\n", ""), HasSubstr("'= ...' is due"));
  EXPECT_THAT(mistake_with("< P+100,P-200,0\n", ""), HasSubstr("'< ...' is due"));
  EXPECT_THAT(mistake_with("fields: P+100 | P-200 | 0\n", ""), HasSubstr("'fields: ...' is due"));
  EXPECT_THAT(mistake_with("wait: ready\n", "wait: ready\ndevice: q_s_sign=bare\n"), HasSubstr("'> ...' is due"));
  EXPECT_THAT(mistake_with("after: 2\n", "after: 2\nwait: ready\n"), StartsWith("a.transcript:16: "));
}

TEST(TranscriptFormat, FieldsAreForDataAndBindWhatNoSimulatorConfirms) {
  EXPECT_EQ(mistake_in("[2 !:]\nsource: R\n> !:\n=\n< R\n"), "");
  EXPECT_THAT(mistake_in("[2 !:]\nsource: R\noffline: why\n> !:\n=\n< R\n"), HasSubstr("'fields: ...' is due"));
  EXPECT_THAT(mistake_in("[2 !:]\nsource: R\n> !:\n=\n< NG\nfields: NG\n"), HasSubstr("out of order"));
}

TEST(TranscriptFormat, AnEmptyLineEndsAnEntry) {
  EXPECT_EQ(split_blocks("[1 A]\n\n\n# b\n[2 B]\nsource: c").size(), 2u);
  EXPECT_TRUE(split_blocks("# nothing\n").empty());
}

}  // namespace
}  // namespace axisgate::shrc203::conformance
