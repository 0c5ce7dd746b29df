// Tables of what the gateway writes and receives at which time, and of what it concludes about a restart of the
// controller between two lines.
#include "device/shot/line/continuity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace axisgate::shot::continuity_test {

void PrintTo(Continuity::Verdict verdict, std::ostream* out) {
  *out << (verdict == Continuity::Verdict::same ? "same" : verdict == Continuity::Verdict::open ? "open" : "foreign");
}

namespace {

using std::chrono::milliseconds;
using testing::IsEmpty;
using Verdict = Continuity::Verdict;

// Transfer time of every line and its answer. An answer is late from 160 ms after its line.
constexpr milliseconds kOnTheWire{10};

TimePoint at(int ms) { return TimePoint{} + milliseconds(ms); }

// Doubt after an answer: none, only a late answer, or more.
enum class Doubt { none, late, open };

struct Step {
  enum class Kind { connected, begin, sent, taken, refused, told };
  int ms;
  Kind kind;
  std::string line = {};                // sent, or reported by ?:CMD
  bool due = false;                     // whether ?:CMD was due before the line was sent
  Doubt doubt = Doubt::none;            // remaining after the answer
  std::optional<Verdict> verdict = {};  // on the line that ?:CMD reported
};

Step connected(int ms) { return {ms, Step::Kind::connected}; }
Step begin(int ms) { return {ms, Step::Kind::begin}; }
Step sent(int ms, std::string line) { return {ms, Step::Kind::sent, std::move(line), false}; }
Step sent_though_due(int ms, std::string line) { return {ms, Step::Kind::sent, std::move(line), true}; }
Step taken(int ms, Doubt doubt = Doubt::none) { return {ms, Step::Kind::taken, {}, false, doubt}; }
Step refused(int ms, Doubt doubt = Doubt::none) { return {ms, Step::Kind::refused, {}, false, doubt}; }
Step told(int ms, std::string line, Verdict verdict, Doubt doubt) {
  return {ms, Step::Kind::told, std::move(line), false, doubt, verdict};
}

struct Case {
  const char* name;
  std::vector<Step> steps;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class ContinuityTable : public testing::TestWithParam<Case> {
 protected:
  void check(const Step& step) {
    const TimePoint now = at(step.ms);
    switch (step.kind) {
      case Step::Kind::connected:
        continuity.connected();
        EXPECT_FALSE(continuity.open());
        return;
      case Step::Kind::begin:
        continuity.begin(now);
        EXPECT_FALSE(continuity.open());
        return;
      case Step::Kind::sent:
        EXPECT_EQ(continuity.due(now), step.due);
        return continuity.wrote(step.line, kOnTheWire, now);
      case Step::Kind::taken:
      case Step::Kind::refused:
        continuity.answered(step.kind == Step::Kind::taken, now);
        break;
      case Step::Kind::told:
        EXPECT_EQ(continuity.compare(step.line, now), step.verdict);
        break;
    }
    EXPECT_EQ(continuity.open(), step.doubt != Doubt::none);
    EXPECT_EQ(continuity.only_late(), step.doubt == Doubt::late);
    EXPECT_FALSE(continuity.due(now)) << "right behind an answer";
  }
  Continuity continuity;
};

TEST_P(ContinuityTable, IsThoughtOfAsItIs) {
  for (const Step& step : GetParam().steps) {
    SCOPED_TRACE("at " + std::to_string(step.ms) + " ms " + step.line);
    check(step);
  }
}

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

const Case kPauses[] = {
    {"LinesSoonAfterAnswersLeaveNoTimeForARestart",
     {begin(0), sent(150, "?:V"), taken(160), sent(310, "O:1"), taken(320), sent(325, "L:1"), refused(335)}},
    {"AfterALongerPauseTheQuestionComesFirst",
     {begin(0), sent(10, "O:1"), taken(20), sent_though_due(171, "?:CMD"), told(180, "O:1", Verdict::same, Doubt::none),
      sent(330, "?:V"), taken(340)}},
    // From now on ?:CMD reports this line, so it can no longer report the line before the pause.
    {"AnotherLineAfterThePauseHidesWhatHappenedInIt",
     {begin(0), sent_though_due(151, "?:V"), taken(160, Doubt::open), sent(170, "?:CMD"),
      told(180, "?:V", Verdict::same, Doubt::open)}},
    {"OtherFactsEndTheDoubt",
     {begin(0), sent_though_due(151, "?:V"), taken(160, Doubt::open), begin(200), sent(210, "O:1"), taken(220)}},
    {"TheAnswerCountsAndNotTheLine", {begin(0), sent(100, "RESET:"), taken(240), sent(390, "?:V"), taken(400)}},
};
INSTANTIATE_TEST_SUITE_P(Pauses, ContinuityTable, testing::ValuesIn(kPauses), name_of);

const Case kLate[] = {
    {"InTime", {begin(0), sent(0, "?:V"), taken(160)}},
    {"TooLate", {begin(0), sent(0, "?:V"), taken(161, Doubt::late)}},
    {"ARefusalIsAnAnswerToo", {begin(0), sent(0, "M:1+P1"), refused(161, Doubt::late)}},
    {"OfTheQuestionItself",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(1000, "?:CMD"),
      told(1161, "O:1", Verdict::same, Doubt::late)}},
    {"AnswersInTimeDoNotUndoIt",
     {begin(0), sent(0, "?:V"), taken(161, Doubt::late), sent(170, "?:SN"), taken(180, Doubt::late)}},
    {"MoreThanLatenessCountsMore",
     {begin(0), sent(0, "?:V"), taken(161, Doubt::late), sent_though_due(312, "?:SN"), taken(320, Doubt::open)}},
    {"LatenessDoesNotMakeLessOfMore",
     {begin(0), sent_though_due(151, "?:V"), taken(160, Doubt::open), sent(170, "?:SN"), taken(400, Doubt::open)}},
    {"ItBeginsAnewWithTheNextDoubt",
     {begin(0), sent_though_due(151, "?:V"), taken(160, Doubt::open), begin(200), sent(200, "?:SN"),
      taken(361, Doubt::late)}},
    // The first answer may be to the first question; the controller may have restarted between the two.
    {"ARepeatedQuestionIsAsOldAsTheFirst",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "?:CMD"), sent_though_due(520, "?:CMD"),
      told(530, "?:CMD", Verdict::same, Doubt::late)}},
    {"OnceAnsweredTheNextQuestionIsNew",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "?:CMD"), told(30, "O:1", Verdict::same, Doubt::none),
      sent_though_due(520, "?:CMD"), told(530, "?:CMD", Verdict::same, Doubt::none)}},
};
INSTANTIATE_TEST_SUITE_P(LateAnswers, ContinuityTable, testing::ValuesIn(kLate), name_of);

const Case kVerdicts[] = {
    {"OurLineBefore",
     {begin(0), sent(0, "WI:W,C"), taken(10), sent_though_due(500, "?:CMD"),
      told(510, "WI:W,C", Verdict::same, Doubt::none)}},
    {"OnlyTheNewestThatWasTaken",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "O:2"), taken(30), sent_though_due(500, "?:CMD"),
      told(510, "O:1", Verdict::foreign, Doubt::open)}},
    {"OfSomebodyElse",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"),
      told(510, "M:1+P1000", Verdict::foreign, Doubt::open)}},
    {"OfSomebodyElseThoughSoonAfter",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "?:CMD"), told(30, "M:1+P1000", Verdict::foreign, Doubt::open)}},
    // The command table here lacks this command, but the manual has it.
    {"OfSomebodyElseWhoKnowsMore",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"),
      told(510, "JO:1+", Verdict::foreign, Doubt::open)}},
    // After a restart ?:CMD may report anything: no command, or the question itself.
    {"NoCommandAtAll",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), told(510, "0", Verdict::open, Doubt::open)}},
    {"TheQuestionThatNobodyAskedBefore",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"),
      told(510, "?:CMD", Verdict::open, Doubt::open)}},
    {"NotWhatTheQuestionBeforeHasToldAlready",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "?:CMD"), told(30, "O:1", Verdict::same, Doubt::none),
      sent_though_due(500, "?:CMD"), told(510, "O:1", Verdict::foreign, Doubt::open)}},
    {"ALineWithoutAnswerMayHaveBeenTaken",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "O:2"), sent_though_due(520, "?:CMD"),
      told(530, "O:2", Verdict::same, Doubt::none)}},
    {"OrMayNot",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "O:2"), sent_though_due(520, "?:CMD"),
      told(530, "O:1", Verdict::same, Doubt::none)}},
    // The first question was written before any restart could have ended, the second was not.
    {"ARestartedControllerMayHaveTakenTheFirstQuestion",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(1000, "?:CMD"),
      told(1010, "?:CMD", Verdict::open, Doubt::open)}},
    {"EvenIfAnotherQuestionWasTakenBeforeThePause",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "?:CMD"), told(30, "O:1", Verdict::same, Doubt::none),
      sent_though_due(500, "?:CMD"), sent_though_due(1000, "?:CMD"), told(1010, "?:CMD", Verdict::open, Doubt::open)}},
    {"ButNotHaveToldTheLineBeforeThePause",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(1000, "?:CMD"),
      told(1010, "O:1", Verdict::same, Doubt::late)}},
    {"NothingIsKnownAfterAConnect",
     {begin(0), sent(0, "O:1"), taken(10), connected(20), begin(20), sent(30, "?:CMD"),
      told(40, "O:1", Verdict::foreign, Doubt::open)}},
    {"AConnectForgetsDoubtAndQuestion",
     {begin(0), sent(0, "O:1"), taken(161, Doubt::late), sent(170, "?:CMD"), connected(900), begin(900),
      sent(910, "O:2"), taken(920), sent(930, "?:CMD"), told(940, "O:2", Verdict::same, Doubt::none)}},
};
INSTANTIATE_TEST_SUITE_P(Verdicts, ContinuityTable, testing::ValuesIn(kVerdicts), name_of);

// The manual does not say whether ?:CMD reports a refused line (manual 40)), and the line may have arrived damaged.
const Case kRefused[] = {
    {"TheRefusedLineIsTold",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "G:1"), refused(30), sent_though_due(500, "?:CMD"),
      told(510, "G:1", Verdict::same, Doubt::none)}},
    {"TheLineBeforeItIsTold",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "G:1"), refused(30), sent_though_due(500, "?:CMD"),
      told(510, "O:1", Verdict::same, Doubt::none)}},
    {"SoonAfterItIsToldAsItCameIn",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "G:1"), refused(30), sent(40, "?:CMD"),
      told(50, "G:3", Verdict::same, Doubt::none)}},
    // The cause may be the line or a restart, but no other program is needed to explain the report.
    {"AfterAPauseThatTellsNothing",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "G:1"), refused(30), sent_though_due(500, "?:CMD"),
      told(510, "G:3", Verdict::open, Doubt::open)}},
    {"OneQuestionUsesItUp",
     {begin(0), sent(0, "O:1"), taken(10), sent(20, "G:1"), refused(30), sent(40, "?:CMD"),
      told(50, "G:3", Verdict::same, Doubt::none), sent(60, "?:CMD"), told(70, "G:3", Verdict::foreign, Doubt::open)}},
    {"AnAnswerUsesItUp",
     {begin(0), sent(0, "G:1"), refused(10), sent(20, "O:1"), taken(30), sent(40, "?:CMD"),
      told(50, "G:3", Verdict::foreign, Doubt::open)}},
    {"ARefusedLineAfterAPauseIsOursAllTheSame",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "G:1"), refused(510, Doubt::open), begin(520),
      sent(530, "?:CMD"), told(540, "G:1", Verdict::same, Doubt::none)}},
};
INSTANTIATE_TEST_SUITE_P(Refusals, ContinuityTable, testing::ValuesIn(kRefused), name_of);

// A stop waits for nothing, so it is written after a ?:CMD that has not been answered yet.
const Case kStops[] = {
    {"BothAnswered",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(500, "L:1"),
      told(510, "O:1", Verdict::same, Doubt::none), taken(520), sent(530, "?:CMD"),
      told(540, "L:1", Verdict::same, Doubt::none)}},
    {"TheStopsAnswerIsMissing",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(500, "L:1"),
      told(510, "O:1", Verdict::same, Doubt::none), sent_though_due(1010, "?:CMD"),
      told(1020, "L:1", Verdict::same, Doubt::none)}},
    {"TheStopNeverCame",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(500, "L:1"),
      told(510, "O:1", Verdict::same, Doubt::none), sent_though_due(1010, "?:CMD"),
      told(1020, "?:CMD", Verdict::same, Doubt::none)}},
    // L:1 proves nothing: both lines were written after the pause.
    {"NeitherIsAnswered",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(500, "L:1"),
      sent_though_due(1100, "?:CMD"), told(1110, "L:1", Verdict::open, Doubt::open), sent(1120, "?:CMD"),
      told(1130, "L:1", Verdict::foreign, Doubt::open)}},
    {"NeitherIsAnsweredAndTheQuestionIsRepeated",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(500, "L:1"),
      sent_though_due(1100, "?:CMD"), sent_though_due(1600, "?:CMD"), told(1610, "L:1", Verdict::open, Doubt::open)}},
    {"NeitherIsAnsweredBeforeAConnect",
     {begin(0), sent_though_due(500, "?:CMD"), sent_though_due(500, "L:1"), sent_though_due(1100, "?:CMD"),
      connected(1200), begin(1200), sent(1210, "?:CMD"), told(1220, "L:1", Verdict::foreign, Doubt::open)}},
    {"SomebodyElsesLineBehindIt",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(500, "L:1"),
      sent_though_due(1100, "?:CMD"), told(1110, "M:1+P1000", Verdict::foreign, Doubt::open)}},
    {"OnceAnsweredTheStopIsNoLongerTheNewest",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "L:1"), sent_though_due(1000, "O:2"),
      taken(1010, Doubt::open), begin(1020), sent(1020, "?:CMD"), told(1030, "L:1", Verdict::foreign, Doubt::open)}},
    {"TheQuestionFindsARestartInFrontOfTheStop",
     {begin(0), sent(0, "O:1"), taken(10), sent_though_due(500, "?:CMD"), sent_though_due(500, "L:1"),
      told(510, "0", Verdict::open, Doubt::open), taken(520, Doubt::open)}},
};
INSTANTIATE_TEST_SUITE_P(Stops, ContinuityTable, testing::ValuesIn(kStops), name_of);

// Both lines were written after the pause, so a controller that restarted during the pause would report the stop too.
TEST(ContinuityStop, WithoutAnyAnswerAfterAPauseProvesNothing) {
  for (const std::string before : {"O:1", "L:1"}) {
    Continuity continuity;
    continuity.begin(at(0));
    continuity.wrote(before, kOnTheWire, at(0));
    continuity.answered(true, at(10));
    continuity.wrote("?:CMD", kOnTheWire, at(500));
    continuity.wrote("L:1", kOnTheWire, at(500));
    continuity.wrote("?:CMD", kOnTheWire, at(1100));
    EXPECT_EQ(continuity.compare("L:1", at(1110)), Verdict::open) << "behind " << before;
    EXPECT_TRUE(continuity.open());
    EXPECT_FALSE(continuity.only_late());
  }
}

class ContinuityTells : public testing::Test {
 protected:
  std::vector<std::string> told_of(std::vector<std::string> lines) const {
    std::erase_if(lines, [this](const std::string& line) { return !continuity.could_be(line); });
    return lines;
  }
  Continuity continuity;
};

// A line looks like a command if it has a verb and a colon (manual 4.), no matter who sent it.
TEST_F(ContinuityTells, WhatLooksLikeACommand) {
  const std::vector<std::string> commands = {"?:V", "!:S", "L:E", "WI:W,C", "PSET:1+P0", "JO:1+", "Q:S", "?:CMD"};
  EXPECT_EQ(told_of(commands), commands);
  EXPECT_THAT(
      told_of({"", "OK", "NG", "1", "R,R,R", ":", ":A", "V2.00.000", "M 1:", "P+1,\x80:", "SIGMAKOKI,SHRC-203"}),
      IsEmpty());
}

// G and *IDN? have no colon, so they are recognised only after being sent.
TEST_F(ContinuityTells, WhatWasSentFromHere) {
  EXPECT_FALSE(continuity.could_be("G"));
  continuity.begin(at(0));
  continuity.wrote("G", kOnTheWire, at(0));
  EXPECT_TRUE(continuity.could_be("G"));
  continuity.answered(true, at(10));
  EXPECT_TRUE(continuity.could_be("G"));
  continuity.wrote("*IDN?", kOnTheWire, at(20));
  EXPECT_TRUE(continuity.could_be("G")) << "*IDN? may not have come in";
  EXPECT_TRUE(continuity.could_be("*IDN?"));
  continuity.answered(true, at(30));
  EXPECT_FALSE(continuity.could_be("G")) << "*IDN? has been answered since";
  continuity.connected();
  EXPECT_FALSE(continuity.could_be("*IDN?"));
}

// The line does not show that nothing happened during the pause before it.
TEST_F(ContinuityTells, NotWhatWasSentAfterAPause) {
  continuity.begin(at(0));
  continuity.wrote("G", kOnTheWire, at(151));
  EXPECT_FALSE(continuity.could_be("G"));
}

}  // namespace
}  // namespace axisgate::shot::continuity_test
