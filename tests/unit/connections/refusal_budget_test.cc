// Refused requests: which have their own journal entry, and which are counted.
#include "server/journal/refusal_budget.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace axisgate::server::journal {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

class RefusalBudgetTest : public testing::Test {
 protected:
  static Entry refusal(std::string who, std::string_view reason = "LEASE_HELD") {
    return {.kind = EntryKind::request_refused,
            .device = "stage",
            .who = std::move(who),
            .body = fmt::format(R"({{"reason":"{}","request":"move"}})", reason)};
  }
  static std::vector<std::string> texts(const std::vector<Entry>& entries) {
    std::vector<std::string> all;
    for (const Entry& entry : entries) all.push_back(entry.who + "|" + entry.body);
    return all;
  }
  // Returns the number of entries that the refusals make.
  std::size_t refuse(int times, const std::string& who) {
    std::size_t entries = 0;
    for (int i = 0; i < times; ++i) entries += budget_.add(refusal(who), now_).size();
    return entries;
  }

  RefusalBudget budget_;
  TimePoint now_{std::chrono::hours(3)};
};

TEST_F(RefusalBudgetTest, SixtyHaveAnEntryAndTheRestIsOneWithItsCount) {
  EXPECT_EQ(refuse(60, "unix anna"), 60u);
  now_ += minutes(1);
  EXPECT_EQ(refuse(6, "unix anna"), 0u);
  EXPECT_THAT(budget_.add(refusal("unix anna", "STOPPED_BY"), now_), IsEmpty());
  now_ += minutes(9) - seconds(1);
  EXPECT_THAT(budget_.due(now_), IsEmpty());
  now_ += seconds(1);
  EXPECT_EQ(budget_.next_due(), now_);
  EXPECT_THAT(texts(budget_.due(now_)), ElementsAre(R"(unix anna|{"count":7,"reason":"STOPPED_BY","request":"move"})"));
  EXPECT_EQ(budget_.next_due(), std::nullopt);
  EXPECT_EQ(refuse(61, "unix anna"), 60u) << "the next ten minutes";
}

TEST_F(RefusalBudgetTest, SixtyMakeNoSum) {
  refuse(60, "unix anna");
  EXPECT_THAT(budget_.due(now_ + minutes(10)), IsEmpty());
}

TEST_F(RefusalBudgetTest, EachIdentityHasItsOwnAndAllAnonymousCallersOverLoopbackAreOne) {
  refuse(60, "unix anna");
  EXPECT_EQ(refuse(1, "unix bert"), 1u);
  EXPECT_EQ(refuse(60, "tcp 127.0.0.1:4001"), 60u);
  EXPECT_EQ(refuse(1, "tcp 127.0.0.1:4002"), 0u);
}

TEST_F(RefusalBudgetTest, ALaterRefusalOfAnybodyWritesWhatIsDue) {
  refuse(62, "unix anna");
  now_ += minutes(10);
  EXPECT_THAT(texts(budget_.add(refusal("unix bert"), now_)),
              ElementsAre(R"(unix anna|{"count":2,"reason":"LEASE_HELD","request":"move"})",
                          R"(unix bert|{"reason":"LEASE_HELD","request":"move"})"));
}

TEST_F(RefusalBudgetTest, AtTheEndTheRestIsWritten) {
  refuse(61, "unix anna");
  EXPECT_THAT(texts(budget_.rest()), ElementsAre(R"(unix anna|{"count":1,"reason":"LEASE_HELD","request":"move"})"));
  EXPECT_THAT(budget_.rest(), IsEmpty());
}

TEST_F(RefusalBudgetTest, OfMoreThanAThousandIdentitiesTheFirstEndsEarly) {
  refuse(61, "unix anna");
  for (int i = 1; i < 1000; ++i) refuse(1, fmt::format("token t{}", i));
  EXPECT_THAT(texts(budget_.add(refusal("unix bert"), now_)),
              ElementsAre(R"(unix anna|{"count":1,"reason":"LEASE_HELD","request":"move"})",
                          R"(unix bert|{"reason":"LEASE_HELD","request":"move"})"));
}

}  // namespace
}  // namespace axisgate::server::journal
