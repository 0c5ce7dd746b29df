// What of a job is refused while its bytes come.
#include "server/api/job_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "device/rml1/profile.h"

namespace axisgate::api {
namespace {

using testing::HasSubstr;

constexpr std::size_t kBuffer = 1024;

Result<CheckedJob> check(const std::vector<std::string>& files) {
  const auto profile = rml1::load_profile(AXISGATE_SOURCE_DIR "/deploy/mills/mdx-540.toml");
  std::vector<PartToSend> parts;
  for (const std::string& file : files) parts.push_back({"T1", file.size()});
  const AcceptedWarnings accepted{"5-2"};
  JobCheck job(*profile, {}, kBuffer, parts, accepted);
  for (const std::string& file : files) {
    if (const Result<void> fed = job.feed(file); !fed) return tl::unexpected(fed.error());
  }
  return job.finish();
}

// In whole, 3 bytes more than they have between the command and its terminator.
std::string groups(int count) {
  std::string job = "PA;\n!ZE";
  for (int i = 0; i < count; ++i) job += i % 2 == 0 ? "X1:" : "X2:";
  return job + ";PU0,0;!MC0;\n";
}

// Without flow control its end would be lost; and a line that does not take it counts as lost.
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

}  // namespace
}  // namespace axisgate::api
