#include <gtest/gtest.h>

#include <cctype>

#include "axisgate/v1/device.pb.h"
#include "device/stage/condition.h"

namespace axisgate::rpc {
namespace {

TEST(ConditionsOfTheApi, HaveTheSameNumberAndNameAsTheStages) {
  for (int number = 1; number < v1::Condition_ARRAYSIZE; ++number) {
    if (!v1::Condition_IsValid(number)) continue;
    std::string expected = "CONDITION_";
    for (const char c : name(stage::Condition{number})) expected += static_cast<char>(std::toupper(c));
    EXPECT_EQ(v1::Condition_Name(static_cast<v1::Condition>(number)), expected);
  }
  for (const stage::Condition condition : stage::reported_conditions()) {
    EXPECT_TRUE(v1::Condition_IsValid(static_cast<int>(condition))) << name(condition);
  }
}

}  // namespace
}  // namespace axisgate::rpc
