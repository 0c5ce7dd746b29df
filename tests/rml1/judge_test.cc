// Tests of each warning that saves a workpiece: given once, at the command that causes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Stock of 1000 x 1000 x 500 steps.
constexpr jobs::Stock kStock{10, 10, 5};

// Returns diagnostics as text, "warning 0 at 7 [5-1]", without the warning about a Z1 of the profile (trace.h).
std::vector<std::string> all(const Check& check) {
  std::vector<std::string> found;
  for (const Diagnostic& one : check.diagnostics().kept()) {
    for (const std::string& line : told_but_z1({one})) found.push_back(line + fmt::format(" [{}]", one.section));
  }
  return found;
}

struct Judged {
  std::vector<std::string> told;
  std::string text;  // of the first diagnostic
};

Judged judge(const std::string& job, CheckOptions options, const Profile& profile = test_profile()) {
  const auto check = checked(job, profile, std::move(options));
  const auto& kept = check->diagnostics().kept();
  return {all(*check), kept.empty() ? "" : kept[0].text};
}
Judged with_stock(const std::string& job) { return judge(job, {kMidway, kStock, {}}); }
Judged with_origin(const std::string& job) { return judge(job, {kMidway, {}, {}}); }
Judged sizes_only(const std::string& job) { return judge(job, {}); }

TEST(Stock, IsLeftBelowTheSurface) {
  const Judged found = with_stock("Z0,0,0;Z1001,0,-100;Z3000,0,-100;Z0,-1,-1;PU;");
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 7 [5-1]"));
  EXPECT_THAT(found.text, HasSubstr("outside of the stock, towards X 10.01 mm, Y 0.00 mm"));
  EXPECT_THAT(with_stock("Z0,0,0;Z-1,0,-1;PU;").told, ElementsAre("warning 0 at 7 [5-1]"));
  EXPECT_THAT(with_stock("Z0,0,0;Z0,1001,-1;PU;").told, ElementsAre("warning 0 at 7 [5-1]"));
}

TEST(Stock, MayBeCutToItsEdges) {
  EXPECT_THAT(with_stock("Z0,0,-500;Z1000,0,-500,1000,1000,-500,0,1000,-1;PU;").told, IsEmpty());
}

TEST(Stock, MayBeLeftAboveTheSurface) { EXPECT_THAT(with_stock("Z5000,-5000,0;PU;").told, IsEmpty()); }

TEST(Stock, IsCutThrough) {
  const Judged found = with_stock("Z5,5,-501;Z5,5,-700;PU;");
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 0 [5-1]"));
  EXPECT_THAT(found.text, HasSubstr("5.01 mm deep, and the stock is 5.00 mm thick"));
}

TEST(Spindle, IsForbiddenBelowTheSurface) {
  const Judged found = sizes_only("!MC0;PD;PU;PD;PU;");
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 5 [5-2]"));
  EXPECT_THAT(found.text, HasSubstr("the spindle is off"));
  EXPECT_THAT(sizes_only("!MC0;!MC1;PD;PU;").told, IsEmpty());
  EXPECT_THAT(sizes_only("!MC0;Z9,9,0;PU;").told, IsEmpty());
}

TEST(Travel, OnTheSurface) {
  const Judged found = with_origin("@-9,0;PU;PU99,0;M0,0;");
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 9 [3-2]", "warning 0 at 16 [3-2]"))
      << "the second one is the way home";
  EXPECT_THAT(found.text, HasSubstr("Z2 = 0"));
  EXPECT_THAT(with_origin("@-9,1;PU;PU99,0;").told, IsEmpty());
}

TEST(Initialize, ComesDownToTheSurface) {
  Profile profile = test_profile();
  profile.default_z2 = 0;
  const Judged found = judge("Z0,0,9;IN;", {kMidway, {}, {}}, profile);
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 7 [3-2]"));
  profile.default_z2 = 1;
  EXPECT_THAT(judge("Z0,0,9;IN;", {kMidway, {}, {}}, profile).told, IsEmpty());
}

// X begins at -10000.
TEST(WorkArea, IsLeftWhileCutting) {
  const Judged found = with_origin("Z0,0,0;Z-10001,0,-10,0,0,-10;Z-10002,0,-10,0,0,-10;PU;");
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 7 [5-1]"));
  EXPECT_THAT(found.text, HasSubstr("what lies outside is not cut"));
  EXPECT_THAT(with_origin("Z0,0,0;Z-10000,50500,-10;PU;").told, IsEmpty());
}

TEST(WorkArea, IsLeftWhileTravelling) {
  EXPECT_THAT(with_origin("PU0,50501;PU0,0;PU0,50502;PU0,0;").told, ElementsAre("note 0 at 0 [5-1]"));
}

TEST(WorkArea, IsNotKnownWithoutOrigin) {
  EXPECT_THAT(sizes_only("Z0,0,0;Z-10001,0,-10;PU;PU50000,50501;").told, IsEmpty());
}

TEST(WorkArea, EndsAtTheBottom) {
  const CheckOptions low{jobs::Origin{100, 100, 55}, {}, {}};
  const Judged found = judge("Z0,0,-551;Z0,0,-2000;PU;", low);
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 0 [5-1]"));
  EXPECT_THAT(found.text, HasSubstr("5.51 mm below the surface, and the machine reaches 5.50 mm"));
  EXPECT_THAT(judge("Z0,0,-550;PU;", low).told, IsEmpty());
}

// 605 mm are 60500 steps.
TEST(Size, IsLargerThanTheMachine) {
  const Judged found = sizes_only("PU-1,0;PU60500,0;PU0,0;PU0,60501;");
  EXPECT_THAT(found.told, ElementsAre("error 0 at 7 [5-1]", "error 0 at 23 [5-1]"));
  EXPECT_THAT(found.text, HasSubstr("605.01 mm in X, where the test mill has 605.00 mm"));
  EXPECT_THAT(sizes_only("PU0,0;PU60500,60500;").told, IsEmpty());
}

TEST(Size, InZCountsFromTheSurfaceDown) {
  // In one pass, which causes a warning as well.
  EXPECT_THAT(sizes_only("Z0,0,-6051;PU;").told, ElementsAre("warning 0 at 0 [3-2]", "error 0 at 0 [5-1]"));
  EXPECT_THAT(sizes_only("Z0,0,-6050;PU;PR;Z0,0,9999;PA;").told, ElementsAre("warning 0 at 0 [3-2]"));
}

TEST(Size, FitsTheOtherUnit) {
  Profile profile = test_profile();
  profile.step_mm = 0.025;
  const CheckOptions options{{}, {}, {{"another", 0.01, 60.5}}};
  const auto check = checked("PU0,0;PU24201,0;", profile, options);
  EXPECT_THAT(all(*check), ElementsAre("error 0 at 6 [5-1]", "warning 0 at 6 [1-1]"));
  EXPECT_THAT(check->diagnostics().kept()[1].text, HasSubstr("if a step is 0.01 mm"));
  EXPECT_THAT(judge("PU0,0;PU60501,0;", options, profile).told, ElementsAre("error 0 at 6 [5-1]"));
}

TEST(End, WithTheToolDown) {
  const Judged found = sizes_only("PU9,9;PD;PD8,8;");
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 9 [3-2]"));
  EXPECT_THAT(found.text, HasSubstr("ends with the tool down, 1.00 mm below the surface"));
  EXPECT_THAT(sizes_only("Z0,0,-5;").told, ElementsAre("warning 0 at 0 [3-2]"));
  for (const char* job : {"PD;PU;", "PD;H;", "PD;IN;", "PD;Z0,0,5;", "PD;!ZM0;", "F5;"}) {
    EXPECT_THAT(sizes_only(job).told, IsEmpty()) << job;
  }
}

TEST(End, WithinACommand) {
  EXPECT_THAT(sizes_only("PD;PU9,9").told, ElementsAre("warning 0 at 3 [2-3]"));
  EXPECT_THAT(sizes_only("PD;PU9,9\n").told, IsEmpty());
  EXPECT_THAT(sizes_only("PD;PU;!ZEX9").told, ElementsAre("warning 0 at 6 [3-3]"));
}

TEST(Pause, IsWarnedOf) { EXPECT_THAT(sizes_only("PD;PU;!NR;").told, ElementsAre("warning 0 at 6 [3-3]")); }

// 25.4 mm, an inch.
TEST(DeepPass, IsTakenAtOnce) {
  const Judged found = sizes_only("!PZ-2540,200;PD;PU;");
  EXPECT_THAT(found.told, ElementsAre("warning 0 at 13 [3-2]"));
  EXPECT_THAT(found.text, HasSubstr("takes 25.40 mm in one pass"));
  EXPECT_THAT(sizes_only("!PZ-1000,200;PD;PU;").told, IsEmpty());
  EXPECT_THAT(sizes_only("!PZ-900,200;PD;PU;!PZ-1800,200;PD;PU;!PZ-2540,200;PD;PU;").told, IsEmpty());
}

TEST(Errors, OfAFileOfAnotherKind) {
  const Judged found = sizes_only("lorem ipsum\n");
  EXPECT_THAT(found.told, testing::Contains("warning 0 at 0 [1-2]"));
  EXPECT_THAT(sizes_only("Q;@-9,9;PD;PU;").told, ElementsAre("error 1 at 0 [2-3]"));
}

TEST(Errors, OfAJobThatHasLostBytes) {
  std::string job = "@-9,9;\n";
  for (int line = 0; line < 10; ++line) job += "PU" + std::to_string(line) + ",9;\n";
  const auto lost = checked(job + "Q;\n,;\n9;\n", test_profile());
  const auto texts = lost->diagnostics().in_order();
  ASSERT_EQ(texts.size(), 4u);
  EXPECT_EQ(texts[0].text,
            "sound before line 12, and from line 12 on 3 errors: is it damaged there, or were bytes lost?");
  EXPECT_EQ(texts[0].place, (jobs::Place{job.size(), 12, 1}));
  EXPECT_EQ(checked(job + "Q;\n,;\n", test_profile())->diagnostics().kept().size(), 2u);
}

}  // namespace
}  // namespace axisgate::rml1
