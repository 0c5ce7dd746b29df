// Tests of the refusal of jobs while their bytes are received.
#include "server/api/mill/job_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "device/rml1/machine/profile.h"
#include "device/rml1/model.h"
#include "tests/paths/paths.h"

namespace axisgate::api {
namespace {

using testing::HasSubstr;

constexpr std::size_t kBuffer = 1024;

const jobs::Model& mdx_540() {
  static const rml1::MillModel model("mdx-540", "", *rml1::load_profile(paths::in_project("deploy/mills/mdx-540.toml")),
                                     {});
  return model;
}

Result<CheckedJob> check(const std::vector<std::string>& files, const std::vector<std::string>& accepted = {},
                         JobPast before = {}) {
  std::vector<PartToSend> parts;
  for (const std::string& file : files) parts.push_back({"T1", file.size()});
  JobCheck job(mdx_540(), {}, kBuffer, parts, accepted, std::move(before));
  for (const std::string& file : files) {
    if (const Result<void> fed = job.feed(file); !fed) return tl::unexpected(fed.error());
  }
  return job.finish();
}

// Returns a job with a command of `count` groups of 3 bytes; the whole command, with its terminator, has 3 + 3 * count
// + 1 bytes.
std::string groups(int count) {
  std::string job = "PA;\n!ZE";
  for (int i = 0; i < count; ++i) job += i % 2 == 0 ? "X1:" : "X2:";
  return job + ";PU0,0;!MC0;\n";
}

// Without flow control the end of the command would be lost. A line that does not accept the command counts as lost.
TEST(AJobCheck, RefusesWhatIsOneWriteAndLongerThanTheBuffer) {
  EXPECT_TRUE(check({groups(340)})) << "1,024 bytes";
  const auto longer = check({groups(341)});
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().reason, Reason::invalid_request);
  EXPECT_EQ(longer.error().message,
            "line 2, column 1: a command of 1027 bytes, which can only be sent as one piece, and the mill's buffer has "
            "1024");
  EXPECT_THAT(check({groups(1), "PA;PU0" + std::string(2000, ' ') + ",0;!MC0;"}).error().message,
              HasSubstr("file 2: line 1, column 4: a command of 2006 bytes"));
}

TEST(AJobCheck, HasNoLimitForWhatIsCut) {
  std::string list = "PA;PU";
  for (int i = 0; i < 10'000; ++i) list += "0,0,";
  EXPECT_TRUE(check({list + "0,0;!MC0;" + std::string(100'000, '\n')}));
}

// Job with two kinds of warnings: a pass of 11 mm, and a tool that is in the cut at the end.
constexpr const char* kDeepAndDown = "PA;!PZ-1100,200;!MC1;PU0,0;\nPD1000,0;\n";

TEST(AJobCheck, KnowsWhatWasAcceptedBefore) {
  const auto again = check({kDeepAndDown}, {}, {{"deep-pass", "tool-left-down"}});
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->accepted.size(), 2u);
  const auto without = check({"PA;!PZ-100,200;!MC1;PU0,0;PD1000,0;PU0,0;!MC0;"}, {}, {{"drags-home"}});
  EXPECT_TRUE(without) << "what the job no longer has is no reason to refuse it: " << without.error().message;
}

// A pass to 11 mm is accepted if an earlier job has already removed the material in two passes of 5.5 mm.
TEST(AJobCheck, KnowsWhatAnotherJobHasRemoved) {
  constexpr const char* kDeep = "PA;!PZ-1100,200;!MC1;PU0,0;\nPD1000,0;\nPU0,0;!MC0;";
  ASSERT_FALSE(check({kDeep}));
  const auto first = mdx_540().make_check({});
  first->feed("PA;!PZ-550,200;!MC1;PU0,0;PD1000,0;PU0,0;!PZ-1100,200;PD1000,0;PU0,0;!MC0;");
  first->finish();
  const auto second = check({kDeep}, {}, {{}, first.get()});
  EXPECT_TRUE(second) << second.error().message;
}

TEST(AJobCheck, RefusesAllKindsOfWarningsAtOnce) {
  const auto refused = check({kDeepAndDown});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, Reason::invalid_request);
  EXPECT_EQ(
      refused.error().message,
      "2 kinds of warnings keep the job from the queue. deep-pass: line 2, column 1: takes 11.00 mm in one pass: with "
      "most tools a pass of this depth breaks the tool; cut in several passes; right where the material was removed "
      "before. tool-left-down: line 2, column 1: the job ends with the tool down, 11.00 mm below the surface; end the "
      "job with the tool up");
  EXPECT_EQ(refused.error().hint,
            "correct the job, or accept what is right: `accepted_warnings` deep-pass,tool-left-down");
  const auto one = check({kDeepAndDown}, {"deep-pass"});
  ASSERT_FALSE(one);
  EXPECT_THAT(one.error().message,
              testing::StartsWith("a warning keeps the job from the queue. tool-left-down: line 2"));
}

TEST(AJobCheck, KeepsWhatWasAccepted) {
  const auto checked = check({kDeepAndDown}, {"tool-left-down", "deep-pass"});
  ASSERT_TRUE(checked) << checked.error().message;
  EXPECT_THAT(checked->accepted, testing::ElementsAre("deep-pass", "tool-left-down"));
  EXPECT_EQ(jobs::size_text(checked->extent), "10.0 x 0.0 mm, 11.00 mm deep");
}

TEST(AJobCheck, RefusesAnAcceptedWarningThatTheJobDoesNotHave) {
  const auto refused = check({kDeepAndDown}, {"deep-pass", "tool-left-down", "outside-stock"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "the job has no warning outside-stock; it has deep-pass, tool-left-down");
  EXPECT_EQ(check({groups(1)}, {"damaged"}).error().message, "the job has no warning damaged; it has none");
}

TEST(AJobCheck, KnowsTheNamesOfWarnings) {
  EXPECT_TRUE(mdx_540().check_warning_name("deep-pass"));
  EXPECT_TRUE(mdx_540().check_warning_name("drags-home"));
  for (const char* name : {"all", "3-2", "warnings", "9-9", ""}) {
    const auto refused = mdx_540().check_warning_name(name);
    ASSERT_FALSE(refused) << name;
    EXPECT_THAT(refused.error().hint, HasSubstr("deep-pass, drags-home"));
  }
}

// A job is roughed in two passes and finished at the whole depth: the finishing only removes the rest.
TEST(AJobCheck, CarriesWhatIsRemovedFromPartToPart) {
  const auto along = [](int depth) {
    return "PA;!PZ-" + std::to_string(depth) + ",200;!MC1;PU0,0;PD1000,0;PU;!MC0;\n";
  };
  EXPECT_TRUE(check({along(600) + along(1150), along(1200)}));
  const auto refused = check({along(600), along(1800)});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("deep-pass: file 2: line 1, column"));
  EXPECT_THAT(refused.error().message, HasSubstr("takes 12.00 mm in one pass"));
}

}  // namespace
}  // namespace axisgate::api
