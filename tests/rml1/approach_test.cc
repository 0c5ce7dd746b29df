// Tests of a job that is continued in its middle: its approach, typed by hand; and random jobs, which from the place on
// must do the same on the simulated mill as the whole job.
#include "device/rml1/mill/approach.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/rml1/courses.h"
#include "tests/rml1/mill.h"
#include "tests/rml1/random_mill_job.h"
#include "tests/rml1/simulator_bench.h"
#include "tests/simulation/random.h"

namespace axisgate::rml1 {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

// Approach to the top with test_profile(): Z rises with 15 mm/s to the top, which is at 0. "Actual Z2 operation stops
// at the topmost location" (guideline 3-3 !PZ), so the tool travels there.
const std::string kUp = "!MC0;^PA;!VZ15;!ZM0;!PZ0,8388607;";

// Returns the text that is written when the job continues at the first command at or after `part`.
std::string words(const std::string& job, const std::string& part, std::optional<jobs::Origin> origin = kWork) {
  const Result<Approach> approach = approach_to(job, job.find(part), test_profile(), origin);
  return approach ? continued(job, *approach) : approach.error().message;
}

TEST(Approach, ToAPlaceThatIsCut) {
  EXPECT_EQ(words("!PZ-100,200;V5;VS3;!MC1;PU100,200;PD300,200;PD300,400;", "PD300,400"),
            kUp + "^PU300,200;!ZM0;^VS3;!VZ5;!PZ;!PZ-100,200;!MC1;^PR;!ZZ0,0,0;^PA;^PD;^PD300,400;");
}

TEST(Approach, ToAPlaceThatIsTravelledTo) {
  EXPECT_EQ(words("!PZ-100,200;PU100,200;PU300,400;", "PU300,400"),
            kUp + "^PU100,200;!ZM0;!VZ;!PZ;!PZ-100,200;!MC1;^PR;!ZZ0,0,0;^PA;^PU;^PU300,400;");
}

TEST(Approach, IntoThreeAxesAtOnce) {
  EXPECT_EQ(words("V5;Z0,0,100;Z10,20,-30,40,50,-60;Z0,0,0;", "Z0,0,0"),
            kUp + "^PU40,50;!ZM0;!VZ5;!PZ;!MC1;^PR;!ZZ0,0,0;^PA;!ZZ40,50,-60;Z0,0,0;");
}

TEST(Approach, IntoAListOfCoordinates) {
  EXPECT_EQ(words("!PZ-100,200;PD10,20,30,40,50,60;", "50,60"),
            kUp + "^PU30,40;!ZM0;!VZ;!PZ;!PZ-100,200;!MC1;^PR;!ZZ0,0,0;^PA;^PD;^PD50,60;");
  EXPECT_EQ(words("!PZ-100,200;D10,20,30,40;", "30,40"),
            kUp + "^PU10,20;!ZM0;!VZ;!PZ;!PZ-100,200;!MC1;^PR;!ZZ0,0,0;^PA;^PD;D30,40;");
}

TEST(Approach, GivesBackDwellRelativeCoordinatesAndSpindleSpeed) {
  EXPECT_EQ(words("!RC8;W200;!PZ-100,200;PU100,200;^PR;PD5,5;PD7,7;", "PD7,7"),
            kUp + "^PU105,205;!ZM0;!VZ;!PZ;!PZ-100,200;!RC8;!MC1;^PR;!ZZ0,0,0;^PA;^PD;!DW200;^PR;^PD7,7;");
}

TEST(Approach, LeavesTheSpindleOffWhereTheJobHasItOff) {
  EXPECT_EQ(words("!MC0;PU100,200;PU1,1;", "PU1,1"), kUp + "^PU100,200;!ZM0;!VZ;!PZ;^PU;^PU1,1;");
  EXPECT_EQ(words("PU100,200;H;PU1,1;", "PU1,1"), kUp + "^PU0,0;!ZM0;!VZ;!PZ;!MC1;^PR;!ZZ0,0,0;^PA;^PU;^PU1,1;")
      << "permitted, and stopped by H";
}

TEST(Approach, DfForgetsWhatWasSetBefore) {
  EXPECT_EQ(words("VS3;W200;!PZ-50,50;^DF;PU100,200;PU1,1;", "PU1,1"),
            kUp + "^PU100,200;!ZM0;!VZ;!PZ;!MC1;^PR;!ZZ0,0,0;^PA;^PU;^PU1,1;");
}

TEST(Approach, ToAMachineHeight) {
  EXPECT_EQ(words("PU100,200;!ZM-300;PU1,1;", "PU1,1", std::nullopt),
            kUp + "^PU100,200;!ZM0;!VZ;!PZ;!MC1;^PR;!ZZ0,0,0;^PA;!ZM-300;^PU1,1;");
}

TEST(Approach, BehindABlankOrALineEndIsTheNextCommand) {
  EXPECT_THAT(words("PU100,200;\n\n  PU1,1;", "\n\n"), EndsWith("^PU;^PU1,1;"));
}

TEST(Approach, BeforeTheFirstCommandItIsTheWholeJob) { EXPECT_EQ(words("\n^IN;PU1,1;", "\n"), "\n^IN;PU1,1;"); }

TEST(Approach, IsRefusedWhereNobodyKnowsTheWay) {
  EXPECT_THAT(words("PU1,1;", ";"), HasSubstr("there is no command at byte 5 of 6 or after it"));
  EXPECT_THAT(words("PU1,1;\n!ZO-100;PU2,2;", "PU2,2"),
              HasSubstr("cannot continue at line 2, column 9: before it the job sets Z0"));
  EXPECT_THAT(words("PU-20000,0;PU2,2;", "PU2,2"), HasSubstr("there the job has left the work area"));
  EXPECT_THAT(words("!PZ-100,200;PD5,5;!ZM0;PA2,2;", "PA2,2"), HasSubstr("would lower the tool to Z1"));
  EXPECT_THAT(words("PU5,5;^PR;Z1,1,-20;Z1,1,-20;", "Z1,1,-20;Z", std::nullopt),
              EndsWith("^PU;^PR;Z1,1,-20;Z1,1,-20;"));
  EXPECT_THAT(words("PU5,5;^PR;Z1,1,-20;Z2,2,-20;", "Z2,2", std::nullopt),
              HasSubstr("without an origin it is not known"));
  EXPECT_THAT(words("PU5,5;^PR;Z1,1,-20;Z2,2,-20;", "Z2,2"), EndsWith("!ZZ6,6,4980;^PR;Z2,2,-20;"));
}

// The mill may already have executed this command.
TEST(Approach, IsNotChosenBeforeWhatNothingGivesBack) {
  Profile profile = test_profile();
  profile.spindle.law = Spindle::Law::direct;
  const auto chosen = [&profile](const std::string& job, const std::string& part) {
    const Result<Approach> approach = approach_to(job, job.find(part), profile, kWork);
    const Result<void> same = check_unchanged(job, *approach, profile, kWork);
    return same ? "chosen" : same.error().message;
  };
  EXPECT_EQ(chosen("PU1,1;PU2,2;", "PU2,2"), "chosen");
  EXPECT_EQ(chosen("PU1,1;PU2,2;!ZO-100;PU3,3;", "PU2,2"),
            "after that place the job sets Z0 (!ZO), and the mill may have done so already");
  EXPECT_THAT(chosen("PU1,1;PU2,2;!RC8;PU3,3;", "PU2,2"), HasSubstr("sets the spindle speed (!RC)"));
  EXPECT_EQ(chosen("!RC5;PU1,1;PU2,2;!RC8;PU3,3;", "PU2,2"), "chosen") << "the way there sets it";
}

TEST(Approach, IsRefusedBehindATurnOfTheRotaryAxis) {
  Profile profile = test_profile();
  profile.rotary = Rotary{'A', false, 10};
  const std::string job = "PU1,1;!ZEA90;PU2,2;";
  EXPECT_TRUE(approach_to(job, job.find("!ZE"), profile, kWork));
  EXPECT_THAT(approach_to(job, job.find("PU2,2"), profile, kWork).error().message, HasSubstr("turns the rotary axis"));
}

TEST(Approach, LinesAndColumnsCountFromOne) {
  const std::string job = "PU1,1;\nPU2,2;PU3,3;\n";
  EXPECT_EQ(jobs::offset_of(job, 1, 1), 0u);
  EXPECT_EQ(jobs::offset_of(job, 2, 1), 7u);
  EXPECT_EQ(jobs::offset_of(job, 2, 7), 13u);
  EXPECT_EQ(jobs::offset_of(job, 3, 1), job.size());
  EXPECT_EQ(jobs::offset_of(job, 99, 1), job.size());
  EXPECT_EQ(jobs::place_of(job, 13), (jobs::Place{13, 2, 7}));
  EXPECT_EQ(jobs::place_of(job, 0), jobs::Place());
  for (std::uint64_t offset = 0; offset < job.size(); ++offset) {
    const jobs::Place place = jobs::place_of(job, offset);
    EXPECT_EQ(jobs::offset_of(job, place.line, place.column), offset);
  }
}

TEST(ContinuedJob, IsJudgedAsTheWholeIs) {
  const Profile profile = test_profile();
  const std::string job = "!PZ-100,200;PU100,200;PD300,200;PU0,0;";
  const Approach good = *approach_to(job, job.find("PU0,0"), profile, kWork);
  EXPECT_TRUE(check_continued(job, good, profile, kWork, std::nullopt));
  Approach bad = good;
  bad.words = "Z0,0,-9000;" + bad.words;
  EXPECT_THAT(check_continued(job, bad, profile, kWork, std::nullopt).error().message,
              HasSubstr("continued at line 1, column 33, the job has a warning that it does not have as a whole"));
}

using Kind = Course::Event::Kind;

// Expects the tool to go up, across at the top, and down, in the events before `end`.
void expect_safe(const Course& course, std::size_t end, std::uint64_t seed) {
  bool across = false, down = false;
  simulator::Position tool = {10'000, 10'000, 0};
  for (std::size_t i = 0; i < end; ++i) {
    const Course::Event& event = course.events[i];
    if (event.kind != Kind::moved) continue;
    const bool moves_across = event.to.x != tool.x || event.to.y != tool.y;
    EXPECT_FALSE(moves_across && (down || event.to.h != 0)) << "seed " << seed << ", event " << i;
    across |= moves_across;
    down |= event.to.h < tool.h;
    tool = event.to;
  }
}

// Returns the job's course without spindle starts, because a continued job starts its spindle earlier.
Course course(const std::string& job, const simulator::MillSetup& setup) {
  Course course = course_of_mill(";^DF;" + job + ";", setup);
  std::erase_if(course.events, [](const Course::Event& event) { return event.kind == Kind::spin_up; });
  return course;
}

TEST(ContinuedJob, DoesFromThereOnWhatTheWholeJobDoes) {
  const Profile profile = test_profile();
  simulator::MillSetup setup = simulator::with_options({});
  setup.profile = profile;
  int continued_jobs = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    simulation::Random random(seed);
    const std::string job = random_mill_job(seed, 400);
    const std::uint64_t from = static_cast<std::uint64_t>(random.between(30, 390));
    const Result<Approach> approach = approach_to(job, from, profile, kWork);
    if (!approach) continue;
    // Skips jobs whose tool would come down while the spindle is prohibited.
    if (!check_continued(job, *approach, profile, kWork, std::nullopt)) continue;
    ++continued_jobs;
    const Course whole = course(job, setup), before = course(job.substr(0, approach->at.offset), setup);
    const Course after = course(continued(job, *approach), setup);
    const std::size_t rest = whole.events.size() - before.events.size();
    ASSERT_GE(after.events.size(), rest) << "seed " << seed;
    const std::size_t way = after.events.size() - rest;
    for (std::size_t i = 0; i < rest; ++i) {
      ASSERT_EQ(after.events[way + i], whole.events[before.events.size() + i])
          << "seed " << seed << ", event " << i << "\n"
          << job << "\n"
          << continued(job, *approach);
    }
    EXPECT_EQ(after.final, whole.final) << "seed " << seed;
    expect_safe(after, way, seed);
  }
  EXPECT_GT(continued_jobs, 200) << "most places can be reached";
}

}  // namespace
}  // namespace axisgate::rml1
