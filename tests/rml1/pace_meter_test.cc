// Tests of a mill's pace, measured from a line that the mill stops: by hand, with the simulated mill, and in use.
#include "device/rml1/sending/pace_meter.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/rml1/fed_mill.h"
#include "tests/rml1/measured_by.h"
#include "tests/rml1/mill_controller_fixture.h"
#include "tests/rml1/sender_line.h"
#include "tests/rml1/short_vectors.h"

namespace axisgate::rml1::pace_meter_test {
namespace {

using simulator::Flow;
using std::chrono::seconds;

class PaceMeterTest : public testing::Test {
 protected:
  // Returns moves of 10 mm at 10 mm/s, a second each. Command n ends at byte 9 + 10 n.
  static std::string a_second_each(int count) {
    std::string job = "!MC0;V10;";
    for (int n = 1; n <= count; ++n) job += n % 2 == 1 ? "Z1000,0,0;" : "Z2000,0,0;";
    return job;
  }
  static TimePoint at(int s) { return TimePoint{} + seconds(s); }

  void expect_range(double least, double most) const {
    ASSERT_TRUE(meter_.pace());
    EXPECT_NEAR(meter_.pace()->least, least, 1e-4);
    EXPECT_NEAR(meter_.pace()->most, most, 1e-4);
  }

  const std::string job_ = a_second_each(400);
  const Profile profile_ = measured_profile();
  const Timeline timeline_{job_, profile_, kAtHome};
  PaceMeter meter_{timeline_, 20};
};

// At the first stop, command 8 may be in progress, or command 10 may have ended. At the second, command 108 may be in
// progress.
TEST_F(PaceMeterTest, IsBetweenWhatWasAndWhatMayHaveBeenExecuted) {
  EXPECT_FALSE(meter_.pace());
  meter_.stopped(109, at(0));
  EXPECT_FALSE(meter_.pace());
  meter_.stopped(609, at(60));
  meter_.stopped(1109, at(120));
  expect_range(120.0 / 103, 120.0 / 97);  // commands 8 to 110, and 11 to 107
}

// The first command begins at an unknown place of the tool. With 48 bytes the mill may still execute it, with 49 the
// mill has begun the second command.
TEST_F(PaceMeterTest, TheFirstCommandIsNotCounted) {
  meter_.stopped(48, at(0));
  meter_.stopped(49, at(60));
  meter_.stopped(1049, at(180));
  expect_range(120.0 / 103, 120.0 / 97);  // commands 2 to 104, and 5 to 101
}

// Commands 11 to 27, or 8 to 30: too few to measure.
TEST_F(PaceMeterTest, SaysNothingOfAShortJob) {
  meter_.stopped(109, at(0));
  meter_.stopped(309, at(20));
  EXPECT_FALSE(meter_.pace());
}

TEST_F(PaceMeterTest, NoTimeIsCountedInWhichTheMillMayHaveWaitedForBytes) {
  meter_.stopped(109, at(0));
  meter_.stopped(1109, at(120));
  meter_.interrupted();
  meter_.stopped(1209, at(1000));
  meter_.stopped(1809, at(1060));
  expect_range(120.0 / 103, 120.0 / 97);  // 57 to 63 commands are less certain
  meter_.stopped(3209, at(1200));
  expect_range(200.0 / 203, 200.0 / 197);  // 200 are more
}

TEST(PaceMeterSlack, IsATenthMoreThanWasMeasuredAndAtLeastOne) {
  const jobs::SendSettings as_measured{.slack_as_measured = true};
  EXPECT_EQ(with_pace(as_measured, std::nullopt).slack, 1.5);
  EXPECT_DOUBLE_EQ(with_pace(as_measured, jobs::MeasuredPace{1.1, 1.2}).slack, 1.32);
  EXPECT_DOUBLE_EQ(with_pace(as_measured, jobs::MeasuredPace{1.4, 1.6}).slack, 1.76)
      << "a mill that is slower than the default has it";
  EXPECT_EQ(with_pace(as_measured, jobs::MeasuredPace{0.5, 0.6}).slack, 1);
  EXPECT_EQ(with_pace({.slack = 1.4}, jobs::MeasuredPace{1, 1.1}).slack, 1.4) << "as it is configured";
}

// Returns a mill that is slower than the high end of the profile by `percent`.
simulator::MillSetup slower_mill(double percent, Flow flow) {
  simulator::MillSetup mill = simulator::with_options({{"acceleration", "worst"}});
  mill.slower_percent = percent;
  mill.flow = flow;
  mill.buffer_bytes = 512;
  return mill;
}

struct Measured {
  Flow flow;
  std::size_t converter;  // bytes
  double percent;
};
void PrintTo(const Measured& one, std::ostream* out) {
  *out << (one.flow == Flow::rts ? "rts" : "xon") << ", " << one.converter << ", " << one.percent;
}

class MeasuredMill : public testing::TestWithParam<Measured> {
 protected:
  std::optional<jobs::MeasuredPace> pace_of(const std::string& job) const {
    const auto [flow, converter, percent] = GetParam();
    return measured_by(job, slower_mill(percent, flow), {.buffer = 512, .converter = converter},
                       {.shows_cts = flow == Flow::rts, .converter = converter});
  }
};

TEST_P(MeasuredMill, IsWithinTheRange) {
  const double truth = 1 + GetParam().percent / 100;
  const auto pace = pace_of(uniform_vectors(1500));
  ASSERT_TRUE(pace);
  EXPECT_LE(pace->least, truth);
  EXPECT_GE(pace->most, truth);
  EXPECT_LE(pace->most, pace->least * 1.2);
  std::cout << fmt::format("| {} | {:.3f} | {:.3f} to {:.3f} |\n", testing::PrintToString(GetParam()), truth,
                           pace->least, pace->most);
}

TEST_P(MeasuredMill, IsNotMeasuredByAShortJob) { EXPECT_FALSE(pace_of(uniform_vectors(100))); }

INSTANTIATE_TEST_SUITE_P(OfAMill, MeasuredMill,
                         testing::Values(Measured{Flow::rts, 0, 0}, Measured{Flow::rts, 0, 20},
                                         Measured{Flow::rts, 128, 20}, Measured{Flow::rts, 0, 100},
                                         Measured{Flow::xon, 0, 20}, Measured{Flow::xon, 128, 20}));

// A mill that is faster than its line never stops the line.
TEST(MeasuredMill, NothingIsMeasuredWhereTheLineIsTheSlowerOne) {
  simulator::MillSetup mill = simulator::with_options({{"acceleration", "none"}});
  mill.flow = Flow::rts;
  const std::string job = vectors(1500, [](int) { return 8; });
  EXPECT_FALSE(measured_by(job, mill, {.converter = 0}, {.shows_cts = true}));
}

TEST(MeasuredMill, PacedStreamingNeverShowsThePace) {
  const std::string job = uniform_vectors(1500);
  const Timeline timeline(job, test_profile(), kMidway);
  AbortBench bench(job, timeline, slower_mill(20, Flow::rts), {.converter = 0}, {.shows_cts = true});
  bench.finish();
  EXPECT_EQ(bench.sender().state(), jobs::SenderState::fed);
  EXPECT_FALSE(bench.sender().measured_pace());
}

// Returns the time that the mill takes with `paced` streaming.
double paced_seconds(const std::string& job, const simulator::MillSetup& mill, jobs::SendSettings settings) {
  simulator::MillSetup setup = mill;
  setup.profile = test_profile();
  const Timeline timeline(job, setup.profile, kAtHome);
  FedMill line(job, setup, settings.baud);
  SenderLine beside(setup.profile, settings, line);
  Sender sender(job, timeline, setup.profile, settings, plan_of(job, timeline, settings), beside.mill());
  feed_all(sender, line, seconds(1), [](TimePoint) {});
  EXPECT_EQ(line.executed(), job.size());
  return line.seconds();
}

TEST(MeasuredMill, APacedJobAfterItTakesLess) {
  const simulator::MillSetup mill = slower_mill(20, Flow::rts);
  const std::string job = uniform_vectors(1500);
  const auto measured = measured_by(job, mill, {.buffer = 512, .converter = 0}, {.shows_cts = true});
  const double before = paced_seconds(job, mill, {.slack_as_measured = true});
  const double after = paced_seconds(job, mill, with_pace({.slack_as_measured = true}, measured));
  EXPECT_LT(after, before * 0.95);
  std::cout << fmt::format("| {:.0f} s | {:.0f} s |\n", before, after);
}

class KeptPace : public MillControllerTest {
 protected:
  KeptPace() { settings_.sending = {.streaming = jobs::Streaming::full, .buffer = 16, .converter = 0}; }

  void run_on(MillController& mill, Duration time) {
    for (const TimePoint end = now_ + time; now_ < end; now_ += std::chrono::milliseconds(1)) {
      line_.run_to(now_);
      mill.advance(now_);
    }
  }

  // Runs the job to FED. The mill takes no bytes for a minute after 300 bytes, and again after 1500.
  void run_to_fed(MillController& mill, jobs::JobNumber number, int count) {
    mill.add({.number = number, .name = "part.rml", .owner = "unix anna", .setup = setup()}, now_);
    ASSERT_TRUE(mill.confirm(number, setup(), "unix bert", now_));
    ASSERT_TRUE(mill.start(number, prepared(count), {.who = "unix anna"}, now_));
    line_.received.clear();
    for (const std::size_t bytes : {300, 1500}) {
      while (mill.running(now_) && line_.received.size() < bytes) run_on(mill, std::chrono::milliseconds(1));
      line_.busy = true;
      run_on(mill, seconds(60));
      line_.busy = false;
    }
    while (mill.running(now_)) run_on(mill, std::chrono::milliseconds(1));
    ASSERT_TRUE(mill.done(number, "unix bert", now_));
  }
};

TEST_F(KeptPace, IsThatOfTheLastJobThatShowedIt) {
  MillController mill(profile_, settings_, line_, *this, permission_);
  mill.link_up(now_);
  EXPECT_FALSE(mill.measured_pace());
  run_to_fed(mill, 1, 200);
  const auto measured = mill.measured_pace();
  ASSERT_TRUE(measured);
  run_to_fed(mill, 2, 20);
  EXPECT_EQ(mill.measured_pace(), measured) << "the second is too short to show it";
}

}  // namespace
}  // namespace axisgate::rml1::pace_meter_test
