// Tests of a sender that feeds the simulated mill over a line of 9600 baud: the mill's real execution lies within the
// range of the progress; the cost of a window, and the window that a job needs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "device/rml1/sending/window.h"
#include "tests/rml1/fed_mill.h"
#include "tests/rml1/sender_line.h"
#include "tests/rml1/short_vectors.h"
#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1::sent_job_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kForever = std::chrono::minutes(10);  // a command may take some seconds

// A mill and the profile by which a sender feeds it.
struct Pair {
  std::string_view name;
  Profile profile;
  std::string_view acceleration;
  double slower_percent;
};
void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

struct Sent {
  int looks = 0, outside = 0;
  std::string first_outside;
  std::uint64_t ahead = 0;  // maximum bytes written and not yet executed
  std::size_t at_most = 0;  // the bound shown before the start
  std::uint64_t width = 0;  // maximum width of the range, bytes
  double seconds = 0, ended_s = 0;
};

std::uint64_t not_executed(const FedMill& line, const jobs::SendProgress& progress) {
  return progress.written - std::min(progress.written, line.executed());
}

simulator::MillSetup mill_of(const Pair& pair) {
  simulator::MillSetup setup = simulator::with_options({{"acceleration", pair.acceleration}});
  setup.profile = pair.profile;
  setup.slower_percent = pair.slower_percent;
  setup.flow = simulator::Flow::rts;
  return setup;
}

Sent sent(const std::string& job, const Pair& pair, jobs::SendSettings settings, Duration period = seconds(1)) {
  const Timeline timeline(job, pair.profile, kAtHome);
  FedMill line(job, mill_of(pair), settings.baud);
  SenderLine beside(pair.profile, settings, line);
  Sender sender(job, timeline, pair.profile, settings, plan_of(job, timeline, settings), beside.mill());
  Sent found;
  found.at_most = sender.run_on().at_most;
  feed_all(sender, line, period, [&](TimePoint now) {
    const jobs::SendProgress progress = sender.progress(now);
    ++found.looks;
    found.ahead = std::max(found.ahead, not_executed(line, progress));
    found.width = std::max(found.width, progress.executed_most - progress.executed_least);
    found.ended_s = std::chrono::duration<double>(now.time_since_epoch()).count();
    if (progress.executed_least <= line.executed() && line.executed() <= progress.executed_most) return;
    if (found.outside++ > 0) return;
    found.first_outside = fmt::format("at {} s {} is not within {} to {}", now.time_since_epoch() / seconds(1),
                                      line.executed(), progress.executed_least, progress.executed_most);
  });
  found.seconds = line.seconds();
  EXPECT_EQ(line.executed(), job.size()) << pair.name;
  return found;
}

struct Paused {
  int pauses = 0;
  double longest_s = 0,
         shown_s =
             0;  // longest time from a pause until everything written is executed; the time shown before the start
};

Paused paused(const std::string& job, const Pair& pair, jobs::SendSettings settings) {
  const Timeline timeline(job, pair.profile, kAtHome);
  FedMill line(job, mill_of(pair), settings.baud);
  SenderLine beside(pair.profile, settings, line);
  Sender sender(job, timeline, pair.profile, settings, plan_of(job, timeline, settings), beside.mill());
  Paused found{.shown_s = std::chrono::duration<double>(sender.run_on().longest).count()};
  const Duration between =
      std::chrono::duration_cast<Duration>(std::chrono::duration<double>(timeline.slowest_s() / 20));
  TimePoint now{}, next_pause = now + between;
  const auto run_to = [&](TimePoint then) {
    now = then;
    line.run_to(now);
    sender.advance(now);
  };
  sender.start(now);
  while (!is_end(sender.state())) {
    run_to(std::max(now, std::min(next_pause, sender.next_deadline(now).value_or(next_pause))));
    if (now < next_pause) continue;
    next_pause = now + between;
    sender.pause();
    if (sender.state() != jobs::SenderState::paused) continue;
    const TimePoint since = now;
    while (line.executed() < sender.progress(now).written && now - since < kForever) run_to(now + milliseconds(1));
    ++found.pauses;
    found.longest_s = std::max(found.longest_s, std::chrono::duration<double>(now - since).count());
    next_pause = now + between;
    sender.resume(now);
  }
  return found;
}

class SentJob : public testing::TestWithParam<Pair> {};

TEST_P(SentJob, TheTruthIsWithinTheRangeAtEverySecond) {
  for (const std::string& job : {uniform_vectors(3000), bursts_of_vectors(3000)}) {
    for (const jobs::Streaming streaming : {jobs::Streaming::paced, jobs::Streaming::full}) {
      const Sent found = sent(job, GetParam(), {.streaming = streaming});
      EXPECT_GE(found.looks, 60);
      EXPECT_EQ(found.outside, 0) << found.first_outside;
    }
  }
}

// Bytes that the line accepts are in the mill's buffer or a converter, or have been read: at most two more commands are
// in the host or in progress.
TEST_P(SentJob, FullStreamingKnowsTheTruthToABuffer) {
  const jobs::SendSettings settings{.streaming = jobs::Streaming::full, .flow_control = true};
  for (const std::string& job : {uniform_vectors(3000), bursts_of_vectors(3000)}) {
    const Sent found = sent(job, GetParam(), settings);
    EXPECT_LE(found.width, settings.buffer + settings.converter + 36);
    EXPECT_LE(found.ended_s, found.seconds + 40) << "what is left takes the slowest mill so long";
  }
}

TEST_P(SentJob, NoMoreIsAheadThanWasShownBeforeTheStart) {
  for (const std::string& job : {uniform_vectors(500), bursts_of_vectors(500)}) {
    for (const std::size_t window : {0, 64, 256}) {
      const Sent found = sent(job, GetParam(), {.window = window}, milliseconds(5));
      EXPECT_LE(found.ahead, found.at_most) << window;
    }
  }
}

// Pauses at about twenty places of the job.
TEST_P(SentJob, APauseEndsWithinTheTimeThatWasShown) {
  for (const std::string& job : {uniform_vectors(500), bursts_of_vectors(500)}) {
    for (const jobs::Streaming streaming : {jobs::Streaming::paced, jobs::Streaming::full}) {
      const Paused found = paused(job, GetParam(), {.streaming = streaming});
      EXPECT_GE(found.pauses, 2);
      EXPECT_LE(found.longest_s, found.shown_s);
    }
  }
}

TEST_P(SentJob, ALargerWindowLosesNoMore) {
  for (const std::string& job : {uniform_vectors(1000), bursts_of_vectors(1000)}) {
    double before = sent(job, GetParam(), {.window = 64}).seconds;
    for (const std::size_t window : {128, 256}) {
      const double now = sent(job, GetParam(), {.window = window}).seconds;
      EXPECT_LE(now, before * 1.001) << window;
      before = now;
    }
    EXPECT_LE(sent(job, GetParam(), {.streaming = jobs::Streaming::full}).seconds, before * 1.001);
  }
}

// Mills from the fastest to the slowest that a sender allows for: its slack is 1.5, and 1.5 times 1.5 is 2.25. The last
// needs no time to accelerate, and its profile says the same.
INSTANTIATE_TEST_SUITE_P(OfAMill, SentJob,
                         testing::Values(Pair{"no acceleration", short_vectors_profile(), "none", 0},
                                         Pair{"the best", short_vectors_profile(), "best", 0},
                                         Pair{"the worst", short_vectors_profile(), "worst", 50},
                                         Pair{"slower", short_vectors_profile(), "worst", 125},
                                         Pair{"measured", measured_profile(), "none", 0}));

// During a vector of 400 ms the 64 bytes are three commands: the next twenty take 8 ms each to drive, and 19 ms each on
// the line.
TEST(AdaptedWindow, LosesNothingWhereASmallOneLoses) {
  const Pair measured{"measured", measured_profile(), "none", 0};
  const std::string job = bursts_of_vectors(2000);
  const double full = sent(job, measured, {.streaming = jobs::Streaming::full}).seconds;
  const auto part = [&](std::size_t window) {
    return sent(job, measured, {.window = window, .slack = 1}).seconds / full;
  };
  EXPECT_GT(part(64), 1.25);
  EXPECT_GT(part(128), 1.15);
  EXPECT_LT(part(256), 1.01);
  EXPECT_LT(part(0), 1.01);
}

TEST(AdaptedWindow, IsTheSmallestThatTheJobAndTheMillNeed) {
  const auto window = [](const std::string& job, const Profile& profile, double slower, int baud) {
    return adapted_window(job, Timeline(job, profile, kAtHome), slower, baud);
  };
  EXPECT_EQ(window(bursts_of_vectors(2000), measured_profile(), 1, 9600), 256u);
  EXPECT_EQ(window(bursts_of_vectors(2000), measured_profile(), 1, 115'200), 64u) << "the line is fast";
  EXPECT_EQ(window(bursts_of_vectors(2000), short_vectors_profile(), 1, 9600), 64u) << "the mill is slow";
  EXPECT_EQ(window(uniform_vectors(2000), measured_profile(), 1, 9600), 64u) << "the line is as fast as each vector";
  EXPECT_EQ(window("PD100,0;", measured_profile(), 1, 9600), 64u);
}

TEST(AdaptedWindow, IsTheBoundThatIsShown) {
  EXPECT_EQ(sent(bursts_of_vectors(100), {"measured", measured_profile(), "none", 0}, {.slack = 1}).at_most, 256u);
  EXPECT_EQ(sent(uniform_vectors(100), {"measured", measured_profile(), "none", 0}, {.slack = 1}).at_most, 64u);
}

// If a move is shorter than its bytes on the line, the line determines the time: ten bits per byte.
TEST(SentJob, TheLineDoesNotRestBetweenCommands) {
  const std::string job = vectors(1000, [](int) { return 8; });
  const double found =
      sent(job, {"measured", measured_profile(), "none", 0}, {.streaming = jobs::Streaming::full}).seconds;
  EXPECT_LT(found, static_cast<double>(job.size()) * 10 / 9600 * 1.005 + 14.2) << "14.2 s to the first point";
}

}  // namespace
}  // namespace axisgate::rml1::sent_job_test
