// Tests of the choice of the device, with and without --device.
#include "clients/axisctl/session.h"

#include <gmock/gmock.h>

#include <string>

#include "clients/axisctl/failure.h"
#include "tests/axisctl/scripted_mill.h"

namespace axisgate::axisctl {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

// Fixture of a daemon with a stage and a mill.
class ChosenDevice : public MillVerbs {
 protected:
  ChosenDevice() { options_.device = ""; }

  // Returns the name of the chosen device, or the message of the failure.
  std::string chosen(v1::Device (*choose)(const Session&)) const {
    try {
      return choose(Session{options_, Connection(options_.target)}).name();
    } catch (const Failure& failure) {
      return failure.message + ": " + failure.hint;
    }
  }
};

TEST_F(ChosenDevice, EachKindHasTheOnlyOneOfItsOwn) {
  EXPECT_EQ(chosen(chosen_device), "devices/stage");
  EXPECT_EQ(chosen(only_mill), "devices/mill");
  EXPECT_EQ(chosen(any_device), "devices/stage");
}

TEST_F(ChosenDevice, OneOfSeveralMustBeNamed) {
  add_device("other", "shrc203");
  EXPECT_EQ(chosen(chosen_device), "the daemon has 2 stages: choose one with --device: stage, other");
  EXPECT_EQ(chosen(any_device), "the daemon has 2 stages: choose one with --device: stage, other");
  EXPECT_EQ(chosen(only_mill), "devices/mill");
  add_device("large", "rml1");
  EXPECT_EQ(chosen(only_mill), "the daemon has 2 mills: choose one with --device: mill, large");
}

TEST_F(ChosenDevice, WithoutAStageTheMillIsLeased) {
  mill_.there.clear_devices();
  add_device("mill", "rml1");
  EXPECT_EQ(chosen(any_device), "devices/mill");
  EXPECT_EQ(chosen(chosen_device), "the daemon has no stage: configure one");
}

TEST_F(ChosenDevice, ANamedMillIsLeasedAndMovesNoAxis) {
  options_.device = "devices/mill";
  EXPECT_EQ(chosen(any_device), "devices/mill");
  EXPECT_THAT(chosen(chosen_device), HasSubstr("devices/mill is a mill: it has no axes to move"));
}

TEST_F(ChosenDevice, TheDaemonExplainsANameThatItDoesNotList) {
  options_.device = "devices/none";
  for (const auto choose : {chosen_device, any_device})
    EXPECT_THAT(chosen(choose), HasSubstr("does not know this call"));
}

}  // namespace
}  // namespace axisgate::axisctl
