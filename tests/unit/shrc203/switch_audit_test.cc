// Memory switches that are reported as changed.
#include "device/shrc203/state/switch_audit.h"

#include <gtest/gtest.h>

namespace axisgate::shrc203::switch_audit_test {
namespace {

TEST(SwitchAudit, ReportsEachSwitchThatIsAnother) {
  SwitchAudit audit;
  audit.before(5, SwitchAudit::Values{"1", "2", "3"});
  audit.after(5, SwitchAudit::Values{"9", "2", "8"});
  const auto reported = audit.result("anna");
  ASSERT_TRUE(reported);
  EXPECT_EQ(reported->who, "anna");
  EXPECT_FALSE(reported->unknown);
  ASSERT_EQ(reported->changes.size(), 2u);
  EXPECT_EQ(reported->changes[0].item, 5);
  EXPECT_EQ(reported->changes[0].number, 0);
  EXPECT_EQ(reported->changes[0].before, "1");
  EXPECT_EQ(reported->changes[0].after, "9");
  EXPECT_EQ(reported->changes[1].number, 2);
}

TEST(SwitchAudit, SaysWhatIsNotKnown) {
  SwitchAudit audit;
  audit.before(0, SwitchAudit::Values{"1"});
  EXPECT_TRUE(audit.result("anna")->unknown) << "what they are now was not read";
  audit.after(0, SwitchAudit::Values{"1", "2"});
  EXPECT_TRUE(audit.result("anna")->unknown) << "another number of them";
  audit.after(0, SwitchAudit::Values{"1"});
  EXPECT_FALSE(audit.result("anna"));
}

}  // namespace
}  // namespace axisgate::shrc203::switch_audit_test
