// Text of facts in the journal's file: each fact is read back exactly as it was published.
#include "server/journal/fact_text.h"

#include <gmock/gmock.h>

#include <set>
#include <variant>
#include <vector>

namespace axisgate::server::fact_text_test {
namespace {

using journal::fact_in;
using journal::text_of;
using std::chrono::nanoseconds;

const Moment kClock{TimePoint(nanoseconds(5'000'000'001)), WallTime(nanoseconds(1'795'456'800'123'456'789))};

template <class What>
What read_again(const What& what) {
  const auto found = fact_in(text_of(FactRecord{.device = "stage", .fact = what, .clock = kClock}));
  EXPECT_TRUE(found);
  EXPECT_EQ(found->clock.monotonic, kClock.monotonic);
  EXPECT_EQ(found->clock.wall, kClock.wall);
  return std::get<What>(found->fact);
}

stage::Motion full_motion() {
  stage::Motion motion;
  motion.id = 12;
  motion.kind = stage::MotionKind::scan;
  motion.state = stage::MotionState::unknown;
  motion.axes = stage::AxisSet::of(1) | stage::AxisSet::of(3);
  motion.results = {{1, 5000, -1250, true}, {3, std::nullopt, std::nullopt, false}};
  motion.problem = Problem{Reason::limit_detected, "axis 1 is at its limit", "move it back", 1, "G:1", "NG"};
  motion.written = true;
  motion.who = "unix jürgen";
  motion.request_id = "scan-7";
  motion.created = TimePoint(nanoseconds(1'000'000'001));
  motion.started = TimePoint(nanoseconds(2'000'000'002));
  motion.ended = TimePoint(nanoseconds(3'000'000'003));
  motion.due = TimePoint(nanoseconds(4'000'000'004));
  motion.segments_total = 20;
  motion.segments_done = 7;
  motion.underruns = 2;
  motion.scan = stage::ScanResult{-10, 910, 115, 9, 8, 7};
  return motion;
}

TEST(FactText, AMotionWithAllThatItHas) {
  const stage::Motion wanted = full_motion(), motion = read_again(stage::MotionChanged{wanted}).motion;
  EXPECT_EQ(motion.id, wanted.id);
  EXPECT_EQ(motion.kind, wanted.kind);
  EXPECT_EQ(motion.state, wanted.state);
  EXPECT_EQ(motion.axes, wanted.axes);
  ASSERT_EQ(motion.results.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(motion.results[i].axis, wanted.results[i].axis);
    EXPECT_EQ(motion.results[i].target_pulses, wanted.results[i].target_pulses);
    EXPECT_EQ(motion.results[i].command_pulses, wanted.results[i].command_pulses);
    EXPECT_EQ(motion.results[i].completion_seen, wanted.results[i].completion_seen);
  }
  EXPECT_TRUE(motion.written);
  EXPECT_EQ(motion.who, wanted.who);
  EXPECT_EQ(motion.request_id, wanted.request_id);
  EXPECT_EQ(motion.created, wanted.created);
  EXPECT_EQ(motion.started, wanted.started);
  EXPECT_EQ(motion.ended, wanted.ended);
  EXPECT_EQ(motion.due, wanted.due);
  EXPECT_EQ(motion.segments_total, wanted.segments_total);
  EXPECT_EQ(motion.segments_done, wanted.segments_done);
  EXPECT_EQ(motion.underruns, wanted.underruns);
}

TEST(FactText, AMotionsProblemAndScan) {
  const stage::Motion motion = read_again(stage::MotionChanged{full_motion()}).motion;
  ASSERT_TRUE(motion.problem);
  EXPECT_EQ(motion.problem->reason, Reason::limit_detected);
  EXPECT_EQ(motion.problem->message, "axis 1 is at its limit");
  EXPECT_EQ(motion.problem->hint, "move it back");
  EXPECT_EQ(motion.problem->axis, 1);
  EXPECT_EQ(motion.problem->sent, "G:1");
  EXPECT_EQ(motion.problem->wire_reply, "NG");
  ASSERT_TRUE(motion.scan);
  EXPECT_EQ(motion.scan->run_from, -10);
  EXPECT_EQ(motion.scan->run_to, 910);
  EXPECT_EQ(motion.scan->interval, 115);
  EXPECT_EQ(motion.scan->expected, 9);
  EXPECT_EQ(motion.scan->expected_in_range, 8);
  EXPECT_EQ(motion.scan->observed, 7);
}

TEST(FactText, WhatAMotionDoesNotHave) {
  const stage::Motion motion = read_again(stage::MotionChanged{}).motion;
  EXPECT_EQ(motion.created, TimePoint());
  EXPECT_FALSE(motion.due);
  EXPECT_FALSE(motion.problem);
  EXPECT_FALSE(motion.scan);
  EXPECT_TRUE(motion.results.empty());
}

TEST(FactText, CompletionsAndThePath) {
  const auto seen = read_again(stage::CompletionSeen{2, 12, true});
  EXPECT_EQ(seen.axis, 2);
  EXPECT_EQ(seen.motion, 12u);
  EXPECT_TRUE(seen.deduced);
  const auto progress = read_again(stage::PathProgress{12, stage::PathProgress::Step::underrun, 5, "OK_D"});
  EXPECT_EQ(progress.motion, 12u);
  EXPECT_EQ(progress.step, stage::PathProgress::Step::underrun);
  EXPECT_EQ(progress.segment, 5);
  EXPECT_EQ(progress.wire_reply, "OK_D");
}

TEST(FactText, TheLinkAndWhatMovesByItself) {
  const auto change =
      read_again(stage::LinkChanged{stage::LinkState::doubtful, "no reply", stage::AxisSet::of(2), "2106001001"});
  EXPECT_EQ(change.link, stage::LinkState::doubtful);
  EXPECT_EQ(change.why, "no reply");
  EXPECT_EQ(change.controllable, stage::AxisSet::of(2));
  EXPECT_EQ(change.serial_number, "2106001001");
  EXPECT_EQ(read_again(stage::ForeignMotion{stage::AxisSet::of(3)}).axes, stage::AxisSet::of(3));
}

TEST(FactText, Stops) {
  const auto stop = read_again(stage::StopRequested{stage::AxisSet::first(3), true, "unix bert"});
  EXPECT_EQ(stop.axes, stage::AxisSet::first(3));
  EXPECT_TRUE(stop.emergency);
  EXPECT_EQ(stop.who, "unix bert");
}

TEST(FactText, AJobOfAMill) {
  jobs::Job job{.number = 7,
                .name = "part.rml",
                .owner = "unix jürgen",
                .setup = {"d1", "MDX-20", "vice", "T1", {}, jobs::Place{20, 2, 5}},
                .bytes = 5000,
                .state = jobs::JobState::paused_unknown};
  job.confirmation = jobs::Confirmation{"unix bert", TimePoint(nanoseconds(1'000'000'001))};
  job.written = jobs::WrittenRange{120, 248};
  job.setup.left = {"job 6 (lid.rml) sets Z0"};
  job.parts = {{"T1", 2000, {std::chrono::seconds(61), std::chrono::seconds(90)}}, {"T3", 5000}};
  job.part = 1;
  const auto read = read_again(JobChanged{job, jobs::SenderState::paused, "unix anna", "the line was lost"});
  EXPECT_EQ(read.job.number, 7u);
  EXPECT_EQ(read.job.name, "part.rml");
  EXPECT_EQ(read.job.owner, "unix jürgen");
  EXPECT_EQ(read.job.setup, job.setup);
  EXPECT_EQ(read.job.bytes, 5000u);
  EXPECT_EQ(read.job.state, jobs::JobState::paused_unknown);
  ASSERT_TRUE(read.job.confirmation && read.job.written);
  EXPECT_EQ(read.job.confirmation->by, "unix bert");
  EXPECT_EQ(read.job.confirmation->until, TimePoint(nanoseconds(1'000'000'001)));
  EXPECT_EQ(*read.job.written, (jobs::WrittenRange{120, 248}));
  EXPECT_EQ(read.job.parts, job.parts);
  EXPECT_EQ(read.job.part, 1u);
  EXPECT_EQ(read.sending, jobs::SenderState::paused);
  EXPECT_EQ(read.who, "unix anna");
  EXPECT_EQ(read.why, "the line was lost");
  const auto plain = read_again(JobChanged{});
  EXPECT_FALSE(plain.job.confirmation);
  EXPECT_FALSE(plain.job.written);
  EXPECT_TRUE(plain.job.parts.empty());
  EXPECT_FALSE(plain.sending);
}

TEST(FactText, ConditionsOfAStage) {
  const auto change = read_again(stage::ConditionChanged{.condition = stage::Condition::mode,
                                                         .axes = stage::AxisSet::of(2),
                                                         .begun = false,
                                                         .value = "HOST",
                                                         .before = TimePoint(nanoseconds(1'000'000'001)),
                                                         .seen = TimePoint(nanoseconds(2'000'000'002))});
  EXPECT_EQ(change.condition, stage::Condition::mode);
  EXPECT_EQ(change.axes, stage::AxisSet::of(2));
  EXPECT_FALSE(change.begun);
  EXPECT_EQ(change.value, "HOST");
  EXPECT_EQ(change.before, TimePoint(nanoseconds(1'000'000'001)));
  EXPECT_EQ(change.seen, TimePoint(nanoseconds(2'000'000'002)));
  EXPECT_EQ(read_again(stage::ConditionChanged{}).before, TimePoint{});
}

TEST(FactText, SwitchesAndPrograms) {
  const auto change = read_again(stage::SwitchesChanged{"unix anna", {{3, 1, "0", "1"}, {8, 0, "a\"b", ""}}, true});
  EXPECT_EQ(change.who, "unix anna");
  ASSERT_EQ(change.changes.size(), 2u);
  EXPECT_EQ(change.changes[0].item, 3);
  EXPECT_EQ(change.changes[0].number, 1);
  EXPECT_EQ(change.changes[0].before, "0");
  EXPECT_EQ(change.changes[0].after, "1");
  EXPECT_EQ(change.changes[1].before, "a\"b");
  EXPECT_TRUE(change.unknown);
  const auto notice = read_again(stage::ProgramNotice{stage::ProgramNotice::Kind::trigger, 9});
  EXPECT_EQ(notice.kind, stage::ProgramNotice::Kind::trigger);
  EXPECT_EQ(notice.count, 9);
}

TEST(FactText, StartsOfTheDaemon) {
  EXPECT_TRUE(read_again(DaemonStarted{true}).after_unclean_end);
  EXPECT_FALSE(read_again(DaemonStarted{false}).after_unclean_end);
}

template <class... What>
std::vector<Fact> one_of_each(const std::variant<What...>*) {
  return {Fact(What())...};
}

TEST(FactText, NoKindOfFactIsTakenForAnother) {
  for (const Fact& fact : one_of_each(static_cast<const Fact*>(nullptr))) {
    EXPECT_EQ(fact_in(text_of(FactRecord{.device = "stage", .fact = fact}))->fact.index(), fact.index());
  }
}

TEST(FactText, BytesOfADeviceThatAreNoTextAreReplaced) {
  const auto progress = read_again(stage::PathProgress{.wire_reply = "OK\xff"});
  EXPECT_EQ(progress.wire_reply, "OK\xef\xbf\xbd");
}

TEST(FactText, WhatIsNoFact) {
  for (const char* text : {"", "{", "[]", "7", "{}", R"({"clock":{"monotonic":0,"wall":0}})",
                           R"({"stop":{"axes":[1]}})", R"({"stop":{"axes":[],"emergency":false,"who":""}})"}) {
    EXPECT_FALSE(fact_in(text)) << text;
  }
}

}  // namespace
}  // namespace axisgate::server::fact_text_test
