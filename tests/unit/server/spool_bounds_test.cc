// Limits on the jobs on disk, and the jobs that are removed to make room.
#include <gmock/gmock.h>

#include <atomic>
#include <thread>
#include <vector>

#include "server/access/access.h"
#include "tests/unit/server/spool_bed.h"

namespace axisgate::server::spool_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// The bounds of one caller and of all callers are small, so that bytes can be counted.
class SpoolBounds : public SpoolBed {
 protected:
  SpoolBounds() { open(bounds()); }
  static spool::Bounds bounds() {
    return {.bytes = 25, .bytes_of_one = 10, .bytes_of_identity = 16, .jobs = 4, .jobs_reserved = 0};
  }
};

TEST_F(SpoolBounds, OfOneJob) {
  EXPECT_TRUE(upload("0123456789"));
  EXPECT_EQ(why(upload("0123456789a", "unix bert")),
            "OUT_OF_RANGE: the job is larger than 10 bytes, the most for one job");
  EXPECT_THAT(files(), ElementsAre("1.json", "1.rml", "last"));
}

TEST_F(SpoolBounds, OfOneCaller) {
  ASSERT_TRUE(upload("0123456789"));
  EXPECT_EQ(why(upload("0123456")),
            "QUEUE_FULL: with it the jobs of unix anna are larger than 16 bytes, the most for one caller");
  EXPECT_TRUE(upload("0123456", "unix bert"));
  EXPECT_TRUE(upload("012345"));
}

TEST_F(SpoolBounds, OfAll) {
  ASSERT_TRUE(upload("0123456789"));
  ASSERT_TRUE(upload("0123456789", "unix bert"));
  EXPECT_EQ(why(upload("012345", "unix carla")),
            "QUEUE_FULL: with it all jobs are larger than 25 bytes, the most together");
  EXPECT_TRUE(upload("01234", "unix carla"));
}

TEST_F(SpoolBounds, OfTheNumberOfJobs) {
  for (int job = 1; job <= 3; ++job) ASSERT_TRUE(upload("0"));
  auto fourth = begin();
  ASSERT_TRUE(fourth);
  EXPECT_EQ(why(begin("unix bert", "lathe")), "QUEUE_FULL: all 4 places of the queue are taken");
  fourth->reset();
  EXPECT_TRUE(begin("unix bert", "lathe"));
}

TEST_F(SpoolBounds, OfTheNumberOfOneCallersJobs) {
  auto few = bounds();
  few.jobs_of_identity = 2;
  open(few);
  ASSERT_TRUE(upload("0"));
  auto second = begin();
  ASSERT_TRUE(second);
  EXPECT_EQ(why(begin()), "QUEUE_FULL: 2 jobs of unix anna are in the queue, the most for one caller");
  EXPECT_TRUE(upload("0", "unix bert"));
  second->reset();
  EXPECT_TRUE(upload("0"));
  ASSERT_TRUE(spool_->end("mill", 1, kNow));
  EXPECT_TRUE(upload("0")) << "what has ended gives way";
  EXPECT_EQ(begin().error().reason, Reason::queue_full);
}

TEST_F(SpoolBounds, TheLastPlacesAreForThoseWhoHaveNoJobWaiting) {
  open({.jobs = 8, .jobs_of_identity = 4, .jobs_reserved = 2});
  for (int job = 1; job <= 4; ++job) ASSERT_TRUE(upload("0"));
  ASSERT_TRUE(upload("0", "unix bert"));
  auto sixth = begin("unix bert");
  ASSERT_TRUE(sixth);
  EXPECT_EQ(why(begin("unix bert")),
            "QUEUE_FULL: 6 of the 8 places of the queue are taken, 2 of them by jobs of unix bert; the last 2 are for "
            "callers without a job in it");
  EXPECT_TRUE(upload("0", "unix root"));
  EXPECT_EQ(begin("unix root").error().reason, Reason::queue_full);
  sixth->reset();
  ASSERT_TRUE(spool_->end("mill", 1, kNow));
  ASSERT_TRUE(spool_->end("mill", 1, kNow)) << "counted once";
  EXPECT_TRUE(upload("0", "unix bert")) << "one that has ended takes no place of the queue";
  EXPECT_EQ(begin("unix bert").error().reason, Reason::queue_full);
  open({.jobs = 8, .jobs_of_identity = 4, .jobs_reserved = 2});
  EXPECT_EQ(begin("unix bert").error().reason, Reason::queue_full) << "also after a restart";
  EXPECT_TRUE(begin("unix carla"));
}

TEST(QueuedAs, CallersWithoutANameAreOne) {
  EXPECT_EQ(queued_as("unix anna"), "unix anna");
  EXPECT_EQ(queued_as(anonymous_caller("127.0.0.1:39482")), "callers without a name");
  EXPECT_EQ(queued_as(kSharedUnixName), "callers without a name");
  EXPECT_EQ(queued_as("callers without a name"), "callers without a name") << "so a clear takes the name of a refusal";
}

TEST_F(SpoolBounds, CountUploadsUnderWay) {
  auto first = begin(), second = begin();
  ASSERT_TRUE((*first)->append("0123456789"));
  ASSERT_TRUE((*second)->append("012345"));
  EXPECT_EQ((*second)->append("6").error().reason, Reason::queue_full);
  first->reset();
  second->reset();
  EXPECT_TRUE(upload("0123456789"));
  EXPECT_TRUE(upload("012345"));
}

TEST_F(SpoolBounds, WhatIsRemovedMakesRoom) {
  ASSERT_TRUE(upload("0123456789"));
  ASSERT_TRUE(upload("012345"));
  ASSERT_FALSE(upload("0"));
  ASSERT_TRUE(spool_->remove("mill", 1));
  EXPECT_TRUE(upload("0123456789"));
}

TEST_F(SpoolBounds, JobsThatHaveEndedGiveWayTheOldestFirst) {
  for (int job = 1; job <= 4; ++job) ASSERT_TRUE(upload("0"));
  ASSERT_TRUE(spool_->end("mill", 3, kNow));
  ASSERT_TRUE(spool_->end("mill", 2, kNow + std::chrono::seconds(1)));
  EXPECT_TRUE(upload("0"));
  EXPECT_THAT(ids(), ElementsAre(1, 2, 4, 5));
  EXPECT_TRUE(upload("0"));
  EXPECT_THAT(ids(), ElementsAre(1, 4, 5, 6));
  EXPECT_EQ(why(upload("0")), "QUEUE_FULL: all 4 places of the queue are taken");
}

TEST_F(SpoolBounds, OnlyOnesOwnGiveWayWhereOnesOwnAreTooMany) {
  ASSERT_TRUE(upload("0123456789", "unix bert"));
  ASSERT_TRUE(spool_->end("mill", 1, kNow));
  ASSERT_TRUE(upload("0123456789"));
  ASSERT_TRUE(spool_->end("mill", 2, kNow + std::chrono::seconds(1)));
  EXPECT_TRUE(upload("012345"));
  EXPECT_THAT(ids(), ElementsAre(1, 3));
}

// Four callers have one job each at a time, and there is room for four: each upload removes an ended job.
TEST_F(SpoolBounds, UploadsAtTheSameTimeFindTheRoomThatTheyMake) {
  open({.jobs = 4});
  std::atomic<int> wrong = 0;
  const auto use = [&](const std::string& identity) {
    for (int i = 0; i < 30; ++i) {
      const auto job = upload("0", identity);
      if (!job || !spool_->end("mill", job->id, kNow)) ++wrong;
    }
  };
  std::vector<std::thread> people;
  for (const char* identity : {"unix anna", "unix bert", "unix carla", "unix dora"}) people.emplace_back(use, identity);
  for (std::thread& person : people) person.join();
  EXPECT_EQ(wrong, 0);
}

TEST_F(SpoolBounds, WhatIsTooOldGoesWithTheNextUpload) {
  ASSERT_TRUE(upload("0"));
  ASSERT_TRUE(spool_->end("mill", 1, kNow - std::chrono::days(30)));
  EXPECT_TRUE(upload("1"));
  EXPECT_THAT(ids(), ElementsAre(2));
}

TEST_F(SpoolBounds, AJobThatLacksAPieceIsNone) {
  auto begun = begin();
  ASSERT_TRUE((*begun)->append("01234567"));
  const std::string refusal = why((*begun)->append("89a"));
  EXPECT_EQ(why((*begun)->append("8")), refusal);
  EXPECT_EQ(why((*begun)->finish()), refusal);
  begun->reset();
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(SpoolBounds, HoldOverARestartAndRefuseNothingThatIsThere) {
  ASSERT_TRUE(upload("0123456789"));
  ASSERT_TRUE(upload("01234"));
  open(bounds());
  EXPECT_FALSE(upload("01"));
  EXPECT_TRUE(upload("0"));
  open({.bytes = 2, .bytes_of_one = 2, .bytes_of_identity = 2, .jobs = 1});
  EXPECT_THAT(ids(), ElementsAre(1, 2, 3)) << "what was refused has no number";
  EXPECT_EQ(spool_->read("mill", 1).value(), "0123456789");
  EXPECT_EQ(begin().error().reason, Reason::queue_full);
}

}  // namespace
}  // namespace axisgate::server::spool_test
