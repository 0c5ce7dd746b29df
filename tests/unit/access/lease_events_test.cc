// Events of leases, and the journal entries that they leave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "server/journal/lease_entries.h"
#include "tests/unit/access/lease_fixture.h"

namespace axisgate::server::lease_events_test {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

// The first token of generation 7 is 7 << 32 | 1, which is 30064771073.
class LeaseEventsTest : public LeaseFixture {
 protected:
  LeaseEventsTest() {
    leases_.on_event = [this](const LeaseEvent& event, TimePoint now) {
      const journal::Entry entry = journal::entry_of(event, "stage", now);
      EXPECT_EQ(entry.device, "stage");
      EXPECT_EQ(entry.boot_time, now_);
      kept_.push_back(name(entry.kind) + "|" + entry.who + "|" + entry.body);
    };
  }
  std::vector<std::string> take() { return std::exchange(kept_, {}); }

  std::vector<std::string> kept_;
};

TEST_F(LeaseEventsTest, ALeaseFromItsGrantToItsRelease) {
  leases_.acquire({.scope = kBoth, .at_loss = AtLoss::finish, .purpose = "for Carl"}, "unix anna", false, now_, now_,
                  [](const Result<Lease>&) {});
  EXPECT_THAT(take(), ElementsAre(R"(lease granted|unix anna|{"at_loss":"finish","axes":[1,2],"lease":30064771073,)"
                                  R"("time_to_live_ms":10000})"))
      << "and not its purpose";
  ASSERT_TRUE(leases_.release(30064771073, now_));
  EXPECT_THAT(take(), ElementsAre(R"(lease ended|unix anna|{"axes":[1,2],"lease":30064771073,"why":"released"})"));
}

TEST_F(LeaseEventsTest, ALeaseThatExpires) {
  held_by("unix anna", kOne);
  take();
  pass(seconds(10));
  pass(seconds(10));
  EXPECT_THAT(take(), ElementsAre(R"(lease ended|unix anna|{"axes":[1],"lease":30064771073,"why":"expired"})"));
}

TEST_F(LeaseEventsTest, ALeaseThatIsHandedOverAndOneWhoseControllerRestarts) {
  const LeaseToken token = held_by("unix anna", kOne);
  wait_for("unix bert", kOne);
  take();
  ASSERT_TRUE(leases_.hand_over(token, "unix bert", now_));
  leases_.device_restarted(now_);
  EXPECT_THAT(take(), ElementsAre(R"(lease ended|unix anna|{"axes":[1],"lease":30064771073,"why":"handed_over"})",
                                  R"(lease granted|unix bert|{"at_loss":"stop","axes":[1],"lease":30064771074,)"
                                  R"("time_to_live_ms":10000})",
                                  R"(lease ended|unix bert|{"axes":[1],"lease":30064771074,"why":"restarted"})"));
}

TEST_F(LeaseEventsTest, ALeaseThatHadEndedIsTakenOverWithoutASecondEnd) {
  const LeaseToken token = held_by("unix anna", kOne);
  begin(1, "unix anna", token, kOne);
  ASSERT_TRUE(leases_.release(token, now_));
  take();
  leases_.take_over({.scope = kOne}, "unix root", now_, [](const Result<Lease>&) {});
  pass(seconds(0));
  leases_.end(1, now_);
  ASSERT_EQ(orders_.size(), 1u);
  EXPECT_THAT(take(), IsEmpty()) << "the stop is in flight";
  leases_.stopped(orders_[0].id, now_);
  EXPECT_THAT(take(), ElementsAre(R"(lease granted|unix root|{"at_loss":"stop","axes":[1],"lease":30064771074,)"
                                  R"("taken_over":true,"time_to_live_ms":10000})"));
}

TEST_F(LeaseEventsTest, ATakeOverACutAndARevokedToken) {
  const LeaseToken annas = held_by("unix anna", kOne, AtLoss::stop_and_release);
  held_by("token night", kTwo);
  held_by("unix carl", AxisSet::of(3));
  take();
  leases_.lost(annas, now_);
  leases_.cut_off("token night", "unix root", now_);
  leases_.take_over({.scope = AxisSet::of(3)}, "unix root", now_, [](const Result<Lease>&) {});
  EXPECT_THAT(take(), ElementsAre(R"(lease ended|unix anna|{"axes":[1],"lease":30064771073,"why":"cut_off"})",
                                  R"(lease ended|token night|{"axes":[2],"lease":30064771074,"why":"token_revoked"})",
                                  R"(lease ended|unix carl|{"axes":[3],"lease":30064771075,"why":"taken_over"})"));
}

TEST_F(LeaseEventsTest, AStopLatchesEachCallerOnceAndARearmLiftsThat) {
  const LeaseToken token = held_by("unix anna", kBoth);
  begin(1, "unix anna", token, kOne);
  begin(2, "unix carl", 0, AxisSet::of(3));
  take();
  stop_by("unix bert", AxisSet::first(3));
  EXPECT_THAT(take(), ElementsAre(R"(latched|unix anna|{"axes":[1,2]})", R"(latched|unix carl|{"axes":[3]})"));
  stop_by("unix bert", AxisSet::first(3));
  EXPECT_THAT(take(), IsEmpty()) << "nobody is held back who was not before";
  rearm("unix anna");
  rearm("unix anna");
  EXPECT_THAT(take(), ElementsAre(R"(rearmed|unix anna|{"axes":[1,2]})")) << "the second had nothing to lift";
}

TEST_F(LeaseEventsTest, AnEndingIsExplainedInWords) {
  using Why = LeaseEnding::Why;
  const auto text = [](Why why) { return text_of(LeaseEnding{why, "unix bert"}); };
  EXPECT_EQ(text(Why::released), "it was released");
  EXPECT_EQ(text(Why::expired), "it was not kept alive and expired");
  EXPECT_EQ(text(Why::handed_over), "it was handed over to unix bert");
  EXPECT_EQ(text(Why::taken_over), "it was taken over by unix bert");
  EXPECT_EQ(text(Why::cut_off), "its holder was cut off");
  EXPECT_EQ(text(Why::token_revoked), "its token was revoked by unix bert");
  EXPECT_EQ(text(Why::restarted), "the controller may have restarted");
}

}  // namespace
}  // namespace axisgate::server::lease_events_test
