// Tests of the clues that a job was made for another machine: lifts, speeds, raster, and the file's own header.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::vector<KnownMachine> kOtherMills = {{"MDX-20", 0.025, 60.5, 15}, {"MDX-50", 0.01, 135, 60}};

std::unique_ptr<Check> with_others(const std::string& job, const Profile& profile = test_profile()) {
  return checked(job, profile, {kMidway, {}, kOtherMills});
}

std::vector<std::string> texts(const Check& check) {
  std::vector<std::string> found;
  for (const Diagnostic& one : check.diagnostics().kept()) found.push_back(one.text);
  return found;
}

// 60.5 mm are 2420 steps of 0.025 mm, and 6050 on the test mill.
TEST(Lift, OfAnotherMachine) {
  const auto check = with_others("Z0,0,0;PR;Z0,0,2420;Z0,0,-2420,0,0,2420;PA;");
  EXPECT_THAT(told(check->diagnostics().kept()), ElementsAre("warning 0 at 10"));
  EXPECT_THAT(texts(*check)[0], HasSubstr("made for the MDX-20, as a lift of 2420 steps is its whole travel: there"));
  EXPECT_THAT(told(with_others("@-9,2420;PU;")->diagnostics().kept()), ElementsAre("warning 0 at 0"));
  EXPECT_THAT(texts(*with_others("Z0,0,0;PR;Z0,0,6050;Z0,0,2421;PA;")), IsEmpty());
}

// 135 mm are 13500 steps of the same length.
TEST(Lift, OfAMachineOfTheSameStepIsNone) { EXPECT_THAT(texts(*with_others("Z0,0,0;PR;Z0,0,13500;PA;")), IsEmpty()); }

// "When the value of the parameter is the model's capacity or higher, the model's maximum speed is used" (3-1 F). Both
// maximum speeds are 15 mm/s here.
TEST(HighestSpeed, IsExceeded) {
  for (const char* job : {"F16.7;", "VS16.7;", "V16.7;", "!VZ16.7;"}) {
    const auto check = with_others(job);
    ASSERT_THAT(told(check->diagnostics().kept()), ElementsAre("warning 0 at 0")) << job;
    EXPECT_THAT(texts(*check)[0], HasSubstr("sets 16.7 mm/s; the test mill has at most 15 mm/s")) << job;
    EXPECT_THAT(texts(*check)[0], Not(HasSubstr("right profile"))) << job;
    EXPECT_EQ(check->speed_not_reached(), 16.7) << job;
  }
  for (const char* job : {"F15;V15;", "F0;V-5;", "F;V;"}) EXPECT_THAT(texts(*with_others(job)), IsEmpty()) << job;
}

TEST(HighestSpeed, IsThatOfAnotherMachine) {
  const auto check = with_others("VS60;VS70;V60;VS60;");
  ASSERT_THAT(told(check->diagnostics().kept()), ElementsAre("warning 0 at 0", "warning 0 at 10"));
  EXPECT_THAT(texts(*check)[0], HasSubstr("the highest speed of the MDX-50: is it the right profile?"));
  EXPECT_EQ(check->speed_not_reached(), 70);
}

// Multiples of 40 steps are whole millimetres with steps of 0.025 mm, and multiples of 0.4 mm here.
TEST(Raster, OfAnotherUnit) {
  const std::string job = "@-9,9;PU40,80;PU120,160;PU200,240;PU280,320;";
  const auto check = with_others(job);
  EXPECT_THAT(told(check->diagnostics().kept()), ElementsAre("note 0 at 6"));
  EXPECT_THAT(texts(*check)[0], HasSubstr("multiples of 40 steps: 1 mm on the MDX-20 with steps of 0.025 mm, 0.4 mm"));
  Profile profile = test_profile();
  profile.step_mm = 0.025;
  EXPECT_THAT(texts(*with_others(job, profile)), IsEmpty());
}

TEST(Raster, NeedsEightCoordinates) {
  EXPECT_THAT(texts(*with_others("@-9,9;PU40,80;PU120,160;PU200,240;PU280,40;")), IsEmpty());
}

// 20 steps are 0.2 mm here, and 0.5 mm with steps of 0.025 mm: both are common.
TEST(Raster, ThatFitsBothUnitsIsNone) {
  EXPECT_THAT(texts(*with_others("@-9,9;PU20,40;PU60,80;PU100,120;PU140,160;")), IsEmpty());
}

TEST(Header, NamesAnotherMachine) {
  const auto check = with_others("PA;\n; for the mdx-20A ;PU;");
  EXPECT_THAT(texts(*check), Contains(HasSubstr("made for the MDX-20, as the file names it")));
  EXPECT_THAT(texts(*with_others("; MDX-500")), Not(Contains(HasSubstr("names it"))));
  EXPECT_THAT(texts(*with_others("; MDX-20 or test mill")), Not(Contains(HasSubstr("made for"))));
}

// Returns a cut-out of 1.7 mm for a machine with steps of 0.01 mm that lifts the tool by 2 mm.
std::string cut_out(int rounds) {
  std::string job = "PA;VS4;!VZ4;!PZ-170,200;!MC1;PU0,0;";
  for (int i = 0; i < rounds; ++i) job += "PD0,0,3800,0,3800,3000,0,3000,0,0;";
  return job + "PU;!MC0;";
}

Profile coarse_profile() {
  Profile profile = test_profile();
  profile.step_mm = 0.025;
  profile.name = "MDX-20";
  return profile;
}

TEST(MadeFor, IsShownByDepthsAndLifts) {
  const auto check = with_others(cut_out(5), coarse_profile());
  ASSERT_THAT(
      texts(*check),
      Contains("made for the MDX-50, as its depths and lifts are usual there: there 38.0 x 30.0 mm, 1.70 mm deep; "
               "here, as MDX-20, 95.0 x 75.0 mm, 4.25 mm deep"));
  EXPECT_THAT(texts(*with_others(cut_out(5))), Not(Contains(HasSubstr("made for"))));
  EXPECT_THAT(texts(*with_others(cut_out(3), coarse_profile())), Not(Contains(HasSubstr("made for")))) << "a trial";
}

// The sender's statement takes precedence over the clues in the job.
TEST(MadeFor, IsSaid) {
  const auto said = [](const Profile& profile, std::string made_for) {
    return texts(*checked(cut_out(5), profile,
                          {.origin = kMidway, .stock = {}, .others = kOtherMills, .made_for = std::move(made_for)}));
  };
  EXPECT_THAT(said(coarse_profile(), "MDX-20"), Not(Contains(HasSubstr("made for"))));
  EXPECT_THAT(said(coarse_profile(), "MDX-50"),
              Contains(HasSubstr("made for the MDX-50, as its sender says so: there 38")));
  EXPECT_THAT(said(test_profile(), "MDX-20"),
              Contains(HasSubstr("made for the MDX-20, as its sender says so: there 95")));
}

}  // namespace
}  // namespace axisgate::rml1
