// Summary of a night, from journals that are written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "server/journal/journal.h"
#include "server/journal/store.h"
#include "server/journal/summary.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::journal {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

const WallTime kEvening = std::chrono::sys_days(std::chrono::year(2026) / 11 / 23) + hours(18);
const WallTime kMorning = kEvening + hours(14);

Entry ended(WallTime time, std::string who, std::string kind, std::string outcome) {
  return {.kind = EntryKind::motion_ended,
          .time = time,
          .device = "stage",
          .who = std::move(who),
          .motion = 1,
          .body = R"({"kind":")" + kind + R"(","outcome":")" + outcome + R"("})"};
}

Entry link(WallTime time, std::string state, std::string device = "stage") {
  return {.kind = EntryKind::link_changed,
          .time = time,
          .device = std::move(device),
          .body = R"({"link":")" + state + R"(","why":""})"};
}

Entry stop(WallTime time, std::string who, bool emergency = false) {
  return {.kind = EntryKind::stop_requested,
          .time = time,
          .device = "stage",
          .who = std::move(who),
          .body = emergency ? R"({"emergency":true})" : R"({"emergency":false})"};
}

Entry daemon(WallTime time, EntryKind kind) { return {.kind = kind, .time = time, .body = "{}"}; }

class SummaryTest : public testing::Test {
 protected:
  void write(const std::vector<Entry>& entries) {
    std::vector<Record> records;
    for (const Entry& entry : entries) records.push_back({entry});
    ASSERT_TRUE(Store::open(path_)->append(records));
  }
  Summary night(Span span = {.from = kEvening, .to = kMorning}) {
    Database database = *Database::open(path_, Database::Access::read);
    const auto summary = summarize(database, span);
    EXPECT_TRUE(summary) << summary.error().message;
    return summary.value_or(Summary());
  }

  const link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "journal.sqlite";
};

auto person(std::string who, WallTime first, WallTime last) {
  return testing::AllOf(testing::Field(&PersonSummary::who, std::move(who)),
                        testing::Field(&PersonSummary::first, first), testing::Field(&PersonSummary::last, last));
}

auto motions(std::string kind, std::string outcome, std::int64_t count) {
  return testing::AllOf(testing::Field(&MotionCount::kind, std::move(kind)),
                        testing::Field(&MotionCount::outcome, std::move(outcome)),
                        testing::Field(&MotionCount::count, count));
}

auto loss(std::string device, WallTime down, std::optional<WallTime> up) {
  return testing::AllOf(testing::Field(&LinkLoss::device, std::move(device)), testing::Field(&LinkLoss::down, down),
                        testing::Field(&LinkLoss::up, up));
}

auto start(WallTime time, bool after_unclean_end) {
  return testing::AllOf(testing::Field(&DaemonStart::time, time),
                        testing::Field(&DaemonStart::after_unclean_end, after_unclean_end));
}

TEST_F(SummaryTest, NothingHappenedInAnEmptyJournal) {
  write({});
  const Summary summary = night();
  EXPECT_THAT(summary.persons.items, IsEmpty());
  EXPECT_THAT(summary.stops.items, IsEmpty());
  EXPECT_THAT(summary.losses.items, IsEmpty());
  EXPECT_THAT(summary.starts.items, IsEmpty());
}

TEST_F(SummaryTest, WhatChangedAtAStageIsListed) {
  const auto body = [](std::string text) {
    return Entry{.kind = EntryKind::condition_changed, .time = kEvening + hours(1), .device = "stage", .body = text};
  };
  write({body(R"({"axes":[1,3],"before_us":1000000,"begun":true,"condition":"emergency_stop","seen_us":2000000})"),
         body(R"({"axes":[],"begun":false,"condition":"mode","seen_us":3000000,"value":"HOST"})"), body("damaged")});
  const Summary summary = night();
  ASSERT_EQ(summary.conditions.items.size(), 2u);
  const ConditionSummary &emergency = summary.conditions.items[0], &mode = summary.conditions.items[1];
  EXPECT_EQ(emergency.device, "stage");
  EXPECT_EQ(emergency.condition, "emergency_stop");
  EXPECT_THAT(emergency.axes, ElementsAre(1, 3));
  EXPECT_TRUE(emergency.begun);
  EXPECT_EQ(emergency.before, WallTime(seconds(1)));
  EXPECT_EQ(emergency.seen, WallTime(seconds(2)));
  EXPECT_FALSE(mode.begun || mode.before);
  EXPECT_EQ(mode.value, "HOST");
  EXPECT_THAT(summary.persons.items, IsEmpty());
}

TEST_F(SummaryTest, OneIdentityIsSummedUpWithWhatIsNobodys) {
  write({daemon(kEvening, EntryKind::daemon_started), ended(kEvening + hours(1), "unix anna", "move", "SUCCEEDED"),
         ended(kEvening + hours(2), "unix bert", "move", "SUCCEEDED"), stop(kEvening + hours(3), "unix bert"),
         stop(kEvening + hours(4), "unix anna"), link(kEvening + hours(5), "DOWN")});
  const Summary summary = night({.from = kEvening, .to = kMorning, .identity = "unix anna"});
  EXPECT_THAT(summary.persons.items, ElementsAre(person("unix anna", kEvening + hours(1), kEvening + hours(4))));
  EXPECT_THAT(summary.stops.items, ElementsAre(testing::Field(&StopSummary::who, "unix anna")));
  EXPECT_THAT(summary.losses.items, ElementsAre(loss("stage", kEvening + hours(5), std::nullopt)));
  EXPECT_THAT(summary.starts.items, ElementsAre(start(kEvening, false)));
}

TEST_F(SummaryTest, CountsTheMotionsOfEachPersonByKindAndOutcome) {
  write({ended(kEvening - seconds(1), "unix anna", "move", "SUCCEEDED"),
         stop(kEvening, "unix bert"),
         ended(kEvening + hours(1), "unix anna", "move", "SUCCEEDED"),
         ended(kEvening + hours(2), "unix anna", "move", "SUCCEEDED"),
         ended(kEvening + hours(3), "unix anna", "move", "FAILED"),
         ended(kEvening + hours(4), "unix bert", "scan", "STOPPED"),
         {.kind = EntryKind::request_refused,
          .time = kEvening + hours(5),
          .device = "stage",
          .who = "unix anna",
          .body = "{}"},
         ended(kMorning, "unix anna", "move", "SUCCEEDED")});
  const Summary summary = night();
  ASSERT_THAT(summary.persons.items, ElementsAre(person("unix bert", kEvening, kEvening + hours(4)),
                                                 person("unix anna", kEvening + hours(1), kEvening + hours(5))))
      << "not what was before the evening, nor in the morning itself";
  EXPECT_THAT(summary.persons.items[0].motions, ElementsAre(motions("scan", "STOPPED", 1)));
  EXPECT_THAT(summary.persons.items[1].motions,
              ElementsAre(motions("move", "FAILED", 1), motions("move", "SUCCEEDED", 2)));
  EXPECT_EQ(summary.persons.items[0].refused, 0);
  EXPECT_EQ(summary.persons.items[1].refused, 1);
}

TEST_F(SummaryTest, AMotionThatWasRefusedBeforeItsFirstLineCountsAsRefusedAlone) {
  Entry motion = ended(kEvening, "unix anna", "move", "FAILED");
  motion.body = R"({"kind":"move","outcome":"FAILED","reason":"LEASE_HELD","refused":true})";
  write({motion,
         {.kind = EntryKind::request_refused,
          .time = kEvening,
          .device = "stage",
          .who = "unix anna",
          .body = R"({"reason":"LEASE_HELD"})"}});
  const Summary summary = night();
  ASSERT_EQ(summary.persons.items.size(), 1u);
  EXPECT_THAT(summary.persons.items[0].motions, IsEmpty());
  EXPECT_EQ(summary.persons.items[0].refused, 1);
}

TEST_F(SummaryTest, RefusalsThatWereSummedUpCount) {
  const Entry one{.kind = EntryKind::request_refused, .time = kEvening, .who = "unix anna", .body = "{}"};
  Entry sum = one;
  sum.body = R"({"count":17,"reason":"LEASE_HELD"})";
  write({one, sum});
  EXPECT_EQ(night().persons.items.at(0).refused, 18);
}

TEST_F(SummaryTest, LinesLeasesAndLatchesAreNotSummedUp) {
  std::vector<Entry> entries;
  for (const EntryKind kind : {EntryKind::lines_exchanged, EntryKind::lease_granted, EntryKind::lease_ended,
                               EntryKind::latched, EntryKind::rearmed}) {
    entries.push_back({.kind = kind, .time = kEvening, .device = "stage", .who = "unix anna", .body = "{}"});
  }
  write(entries);
  EXPECT_THAT(night().persons.items, IsEmpty());
}

TEST_F(SummaryTest, MotionsOfNobodyCountAndOtherEntriesOfNobodyDoNot) {
  write({link(kEvening + hours(1), "UP"), ended(kEvening + hours(2), "", "jog", "STOPPED")});
  EXPECT_THAT(night().persons.items, ElementsAre(person("", kEvening + hours(2), kEvening + hours(2))));
}

TEST_F(SummaryTest, TextThatIsNoJsonIsNoMotionOfAnyKind) {
  write({ended(kEvening, "unix anna", "move", "SUCCEEDED")});
  ASSERT_TRUE(Database::open(path_, Database::Access::write)->run("UPDATE entry SET body = 'moved'"));
  EXPECT_THAT(night().persons.items.at(0).motions, ElementsAre(motions("", "", 1)));
}

TEST_F(SummaryTest, ShowsWhoStoppedWhat) {
  write({stop(kEvening + hours(1), "unix bert"), stop(kEvening + hours(2), "unix anna", true)});
  const auto stops = night().stops.items;
  ASSERT_EQ(stops.size(), 2u);
  EXPECT_EQ(stops[0].time, kEvening + hours(1));
  EXPECT_EQ(stops[0].who, "unix bert");
  EXPECT_EQ(stops[0].device, "stage");
  EXPECT_FALSE(stops[0].emergency);
  EXPECT_EQ(stops[1].who, "unix anna");
  EXPECT_TRUE(stops[1].emergency);
}

TEST_F(SummaryTest, OfManyStopsShowsTheFirstHundredAndCountsTheRest) {
  std::vector<Entry> many;
  for (int i = 0; i < 107; ++i) many.push_back(stop(kEvening + seconds(i), "unix bert"));
  write(many);
  const Summary summary = night();
  ASSERT_EQ(summary.stops.items.size(), 100u);
  EXPECT_EQ(summary.stops.items.back().time, kEvening + seconds(99));
  EXPECT_EQ(summary.stops.more, 7);
}

TEST_F(SummaryTest, ALossLastsUntilTheLineIsUpAgain) {
  write({link(kEvening + hours(1), "UP"), link(kEvening + hours(2), "DOWN"),
         link(kEvening + hours(2) + seconds(5), "CONNECTING"), link(kEvening + hours(2) + seconds(6), "DOWN"),
         link(kEvening + hours(2) + seconds(7), "CONNECTING"), link(kEvening + hours(2) + seconds(8), "UP")});
  EXPECT_THAT(night().losses.items, ElementsAre(loss("stage", kEvening + hours(2), kEvening + hours(2) + seconds(8))));
}

TEST_F(SummaryTest, EachLineHasItsOwnLossesInTheOrderInWhichTheyBegan) {
  write({link(kEvening + minutes(1), "DOWN", "left"), link(kEvening + minutes(2), "DOWN", "right"),
         link(kEvening + minutes(3), "UP", "right"), link(kEvening + minutes(5), "UP", "left")});
  EXPECT_THAT(night().losses.items, ElementsAre(loss("left", kEvening + minutes(1), kEvening + minutes(5)),
                                                loss("right", kEvening + minutes(2), kEvening + minutes(3))));
  EXPECT_THAT(night({.from = kEvening, .to = kMorning, .device = "right"}).losses.items,
              ElementsAre(loss("right", kEvening + minutes(2), kEvening + minutes(3))));
}

TEST_F(SummaryTest, ALossMayBeginBeforeTheNightAndEndAfterIt) {
  write({link(kEvening - hours(9), "DOWN"), link(kEvening - hours(8), "UP"), link(kEvening - hours(2), "DOWN"),
         link(kEvening - hours(1), "CONNECTING"), link(kEvening - hours(1) + seconds(3), "DOWN"),
         link(kEvening + hours(1), "UP"), link(kMorning - minutes(1), "DOWN"), link(kMorning, "CONNECTING"),
         link(kMorning + minutes(1), "UP"), link(kMorning + minutes(2), "DOWN")});
  EXPECT_THAT(night().losses.items, ElementsAre(loss("stage", kEvening - hours(2), kEvening + hours(1)),
                                                loss("stage", kMorning - minutes(1), kMorning + minutes(1))));
}

TEST_F(SummaryTest, ALineMayBeDownForTheWholeNight) {
  write({link(kEvening - hours(2), "DOWN")});
  EXPECT_THAT(night().losses.items, ElementsAre(loss("stage", kEvening - hours(2), std::nullopt)));
  EXPECT_THAT(night({.from = kEvening, .to = kMorning, .device = "other"}).losses.items, IsEmpty());
}

TEST_F(SummaryTest, ALineThatWasUpInTheEveningIsNotLost) {
  write({link(kEvening - hours(2), "DOWN"), link(kEvening - hours(1), "UP")});
  EXPECT_THAT(night().losses.items, IsEmpty());
}

TEST_F(SummaryTest, ALineThatThePresentDaemonDoesNotHaveIsNotDownForever) {
  write({link(kEvening - hours(9), "DOWN", "sold"), link(kEvening - hours(9), "DOWN", "kept"),
         daemon(kEvening - hours(8), EntryKind::daemon_started), link(kEvening - hours(8), "DOWN", "kept")});
  EXPECT_THAT(night().losses.items, ElementsAre(loss("kept", kEvening - hours(9), std::nullopt)));
}

// The clock was set back after the first entries.
TEST_F(SummaryTest, WhatIsOutOfTheOrderOfTimeIsInTheOrderOfNumbers) {
  using enum EntryKind;
  write({daemon(kEvening + hours(3), daemon_started), link(kEvening + hours(4), "DOWN"),
         link(kEvening + hours(2), "UP"), daemon(kEvening + hours(2), daemon_ended),
         daemon(kEvening + hours(2) + minutes(1), daemon_started), link(kEvening + hours(3), "DOWN"),
         link(kEvening + hours(5), "UP")});
  EXPECT_THAT(night().losses.items, ElementsAre(loss("stage", kEvening + hours(3), kEvening + hours(5)),
                                                loss("stage", kEvening + hours(4), kEvening + hours(2))));
  EXPECT_THAT(night().starts.items,
              ElementsAre(start(kEvening + hours(3), false), start(kEvening + hours(2) + minutes(1), false)));
}

TEST_F(SummaryTest, AStartWithoutAnEndBeforeItIsAfterAnUncleanEnd) {
  using enum EntryKind;
  write({daemon(kEvening - hours(3), daemon_started), daemon(kEvening + hours(1), daemon_started),
         daemon(kEvening + hours(2), daemon_ended), daemon(kEvening + hours(3), daemon_started),
         daemon(kEvening + hours(4), daemon_started)});
  EXPECT_THAT(night().starts.items, ElementsAre(start(kEvening + hours(1), true), start(kEvening + hours(3), false),
                                                start(kEvening + hours(4), true)));
  EXPECT_EQ(night({.from = kEvening, .to = kMorning, .device = "stage"}).starts.items.size(), 3u);
}

TEST_F(SummaryTest, TheFirstStartOfAllFollowsNoUncleanEnd) {
  write({daemon(kEvening + hours(1), EntryKind::daemon_started)});
  EXPECT_THAT(night().starts.items, ElementsAre(start(kEvening + hours(1), false)));
}

TEST_F(SummaryTest, ADeviceIsAskedAlone) {
  write({ended(kEvening + hours(1), "unix anna", "move", "SUCCEEDED"), stop(kEvening + hours(2), "unix bert")});
  const Summary other = night({.from = kEvening, .to = kMorning, .device = "other"});
  EXPECT_THAT(other.persons.items, IsEmpty());
  EXPECT_THAT(other.stops.items, IsEmpty());
  EXPECT_EQ(night({.from = kEvening, .to = kMorning, .device = "stage"}).persons.items.size(), 2u);
}

TEST_F(SummaryTest, WithoutTimesAllIsSummedUp) {
  const auto journal = *Journal::open(path_);
  journal->append({ended(kEvening - hours(100), "unix anna", "move", "SUCCEEDED")});
  journal->append({ended(kMorning + hours(100), "unix anna", "move", "SUCCEEDED")});
  const auto all = journal->summarize({});
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_THAT(all->persons.items, ElementsAre(person("unix anna", kEvening - hours(100), kMorning + hours(100))));
}

TEST_F(SummaryTest, WhatTheDiskRefusesIsAProblem) {
  write({});
  ASSERT_TRUE(Database::open(path_, Database::Access::write)->run("ALTER TABLE entry RENAME TO away"));
  Database database = *Database::open(path_, Database::Access::read);
  EXPECT_FALSE(summarize(database, {}));
}

}  // namespace
}  // namespace axisgate::server::journal
