// Properties of the table's rows besides their lines, typed from the manual.
#include "device/shrc203/command/command_table.h"

#include <gtest/gtest.h>

namespace axisgate::shrc203::command_table_test {

// In MANUAL, TEACHING and similar modes the controller answers questions about itself and its registers, but executes
// no commands.
TEST(CommandTable, QuestionsAreAnsweredOffHost) {
  for (const char* name : {"?:W", "?:D", "?:MODE", "?:CMD", "?:L", "*IDN?"}) {
    EXPECT_TRUE(model().row(name).answered_off_host()) << name;
  }
  for (const char* name : {"Q:S", "!:", "I:", "M:", "G:", "L:", "MODE:"}) {
    EXPECT_FALSE(model().row(name).answered_off_host()) << name;
  }
}

}  // namespace axisgate::shrc203::command_table_test
