// What the rows say beside their lines, typed from the manual.
#include "device/shrc203/command/command_table.h"

#include <gtest/gtest.h>

namespace axisgate::shrc203::command_table_test {

// In MANUAL, TEACHING and the like the controller still says what it is and what it holds; it takes no orders.
TEST(CommandTable, QuestionsAreAnsweredOffHost) {
  for (const char* name : {"?:W", "?:D", "?:MODE", "?:CMD", "?:L", "*IDN?"}) {
    EXPECT_TRUE(command_row(name).answered_off_host()) << name;
  }
  for (const char* name : {"Q:S", "!:", "I:", "M:", "G:", "L:", "MODE:"}) {
    EXPECT_FALSE(command_row(name).answered_off_host()) << name;
  }
}

}  // namespace axisgate::shrc203::command_table_test
