// Tests of each part that bounds an abort, by leaving the part out, and of the limits of any abort.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "device/rml1/sending/commands.h"
#include "tests/rml1/abort_bench.h"
#include "tests/rml1/trace.h"

namespace axisgate::rml1::abort_guard_test {
namespace {

using simulator::Flow;
using simulator::MillBench;
using simulator::MillSetup;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kTop = 5000;  // steps above Z0

MillSetup mill_of(std::string_view escape_k, Flow flow = Flow::none) {
  MillSetup mill = simulator::with_options({{"escape_k", escape_k}, {"acceleration", "worst"}});
  mill.buffer_bytes = 512;
  mill.flow = flow;
  return mill;
}

// A job and the time of its abort after the start.
struct Case {
  std::string job;
  MillSetup mill;
  jobs::SendSettings settings;
  LineToMill::Setup line{};
  Duration at = seconds(60);
};

struct Outcome {
  std::size_t ran_on;
  jobs::RunOn bound;
};

Outcome aborted(const Case& one) {
  const Profile profile = test_profile();
  const Timeline timeline(one.job, profile, kMidway);
  jobs::SendSettings settings = one.settings;
  settings.buffer = one.mill.buffer_bytes;
  settings.converter = one.line.converter;
  AbortBench bench(one.job, timeline, one.mill, settings, one.line);
  bench.run_for(one.at);
  bench.abort();
  bench.finish();
  return {bench.ran_on(), bench.sender().run_on()};
}

// Returns a job of cuts with the tool down: 5 mm and 10 bytes each.
std::string cuts(int count) {
  std::string job = "^PA;V15;VS15;PU0,0;PD0,0;";
  for (int i = 0; i < count; ++i) job += i % 2 == 0 ? "PD0500,00;" : "PD0000,00;";
  return job;
}

TEST(AbortGuard, Window) {
  Case one{cuts(400), mill_of("in-band", Flow::rts), {}, {.shows_cts = true}};
  EXPECT_LE(aborted(one).ran_on, 64u);
  one.settings.streaming = jobs::Streaming::full;
  EXPECT_GT(aborted(one).ran_on, 300u);
}

TEST(AbortGuard, Slack) {
  Case one{cuts(400), mill_of("in-band"), {}};
  one.mill.slower_percent = 50;
  EXPECT_LE(aborted(one).ran_on, aborted(one).bound.at_most);
  one.settings.slack = 1;
  EXPECT_GT(aborted(one).ran_on, aborted(one).bound.at_most);
}

// Bytes that have left the host may not have arrived yet.
TEST(AbortGuard, TimeOnTheLine) {
  std::string settings = "^PA;V15;VS15;PU500,0;";
  for (int i = 0; i < 400; ++i) settings += "VS15;";
  const Case one{settings, mill_of("in-band"), {}, {.converter = 256}, milliseconds(4500)};
  EXPECT_LE(aborted(one).ran_on, aborted(one).bound.at_most);
  EXPECT_GT(aborted(one).ran_on, 0u);
}

// While the mill executes one command, its buffer can be full without this command, and one more waits in the host.
TEST(AbortGuard, TheCommandUnderWay) {
  const std::string still = "PU" + std::string(46, '0') + "1500,00000000;";  // 61 bytes
  std::string job = "^PA;V15;VS15;" + still;
  for (int i = 0; i < 50; ++i) job += still;
  const Case one{job,
                 mill_of("in-band", Flow::xon),
                 {.streaming = jobs::Streaming::full},
                 {.converter = 128, .late = 128},
                 milliseconds(2990)};
  const Outcome outcome = aborted(one);
  EXPECT_LE(outcome.ran_on, outcome.bound.at_most);
  EXPECT_GT(outcome.ran_on, 512u + 128 + still.size()) << "one command is not enough";
}

// An abort must not depend on the mill stopping the host.
TEST(AbortGuard, FlowControlIsIgnored) {
  const std::string job = cuts(400);
  const Profile profile = test_profile();
  const Timeline timeline(job, profile, kMidway);
  for (const Flow flow : {Flow::xon, Flow::rts}) {
    for (const bool can_ignore : {false, true}) {
      AbortBench bench(job, timeline, mill_of("toggle", flow), {.streaming = jobs::Streaming::full},
                       {.shows_cts = flow == Flow::rts, .can_ignore = can_ignore});
      bench.run_for(seconds(3));
      bench.abort();
      bench.run_for(seconds(5));
      EXPECT_EQ(bench.sender().state(), can_ignore ? jobs::SenderState::aborted : jobs::SenderState::aborting);
      EXPECT_EQ(bench.state().tool.z == kTop, can_ignore);
    }
  }
}

// A mill that `words` reach 12 s after a job began.
struct Reached {
  Reached(const std::string& job, std::string_view words) : bench(mill_of("toggle")) {
    bench.send(job);
    bench.wait_ms(12'000);
    bench.lines.clear();
    const TimePoint sent = bench.now;
    bench.send(words);
    bench.finish();
    took = bench.now - sent;
    state = bench.mill.state(bench.now);
  }

  MillBench bench;
  Duration took{};
  simulator::Simulator::State state;
};

std::string without(std::string words, std::string_view part) { return words.erase(words.find(part), part.size()); }

// Slow cut; the words arrive in its middle.
constexpr const char* kCutting = "^PA;V15;PD0,0;V0.5;VS1;PD1500,0;PD0,0;";

TEST(AbortWords, EscapeKTwice) {
  const std::string words = abort_commands(test_profile(), false);
  EXPECT_EQ(Reached(kCutting, words).state.tool.z, kTop);
  const Reached once(kCutting, without(words, "\x1B.K"));
  EXPECT_EQ(once.state.tool.z, -100);
  EXPECT_GT(once.state.rpm, 0);
}

TEST(AbortWords, SpindleForbiddenBeforeTheRaise) {
  const std::string resting = "!MC0;^PA;V15;PD0,0;!MC1;", words = abort_commands(test_profile(), true);
  EXPECT_TRUE(Reached(resting, words).bench.recorded("spindle").empty());
  EXPECT_EQ(Reached(resting, without(words, "!MC0;")).bench.recorded("spindle").size(), 2u) << "it turns, and stops";
}

TEST(AbortWords, AbsoluteCoordinates) {
  const std::string relative = "^PA;V15;PD0,0;^PR;VS1;PD1500,0;", words = abort_commands(test_profile(), false);
  EXPECT_EQ(Reached(relative, words).state.tool.z, kTop);
  EXPECT_EQ(Reached(relative, without(words, "^PA;")).state.tool.z, -100);
}

TEST(AbortWords, HighestSpeed) {
  const std::string words = abort_commands(test_profile(), false);
  EXPECT_LT(Reached(kCutting, words).took, seconds(5));
  EXPECT_GT(Reached(kCutting, without(words, "!VZ15;")).took, seconds(90));
}

TEST(AbortWords, SpindleOff) {
  const std::string words = abort_commands(test_profile(), false);
  EXPECT_EQ(Reached(kCutting, words).state.rpm, 0);
  EXPECT_GT(Reached(kCutting, without(words, "!MC0;")).state.rpm, 0);
}

// Keeps VIEW pressed until the mill's buffer is full, and releases it 5 s after the abort.
void abort_with_full_buffer(AbortBench& bench) {
  bench.run_for(seconds(10));
  bench.press_view();
  bench.run_for(seconds(90));
  bench.abort();
  bench.run_for(seconds(5));
  bench.press_view();
  bench.finish();
}

// With in-band ESC.K, the abort needs room in the buffer; its words need room in every interpretation.
TEST(AbortLimit, AFullBufferTakesItOnlyWhereEscapeKEmptiesIt) {
  const std::string job = cuts(400);
  const Profile profile = test_profile();
  const Timeline timeline(job, profile, kMidway);
  for (const char* escape_k : {"toggle", "one-shot", "in-band"}) {
    AbortBench bench(job, timeline, mill_of(escape_k), {.buffer = 512}, {});
    abort_with_full_buffer(bench);
    const bool empties = std::string_view(escape_k) != "in-band";
    EXPECT_EQ(bench.abort_lost(), !empties) << escape_k;
    EXPECT_EQ(bench.state().tool.z == kTop, empties) << escape_k;
    EXPECT_LE(bench.ran_on(), bench.sender().run_on().if_held) << escape_k;
  }
}

// A full buffer may also discard ESC.K (guideline 4-1, error 16).
TEST(AbortLimit, AFullBufferMayDropEscapeK) {
  const std::string job = cuts(400);
  const Profile profile = test_profile();
  const Timeline timeline(job, profile, kMidway);
  const MillSetup mill = simulator::with_options({{"escape_k_when_full", "dropped"}}, mill_of("toggle"));
  AbortBench bench(job, timeline, mill, {.buffer = 512}, {});
  abort_with_full_buffer(bench);
  EXPECT_TRUE(bench.abort_lost());
  EXPECT_LT(bench.state().tool.z, kTop);
  EXPECT_LE(bench.ran_on(), bench.sender().run_on().if_held);
}

TEST(AbortLimit, ViewMayDiscardIt) {
  const std::string job = cuts(400);
  const Profile profile = test_profile();
  const Timeline timeline(job, profile, kMidway);
  MillSetup mill = simulator::with_options({{"view_data", "discarded"}}, mill_of("in-band"));
  mill.slower_percent = 50;
  AbortBench bench(job, timeline, mill, {}, {});
  bench.run_for(seconds(20));
  bench.abort();
  bench.run_for(milliseconds(500));
  bench.press_view();
  bench.run_for(seconds(5));
  bench.press_view();
  bench.finish();
  EXPECT_LT(bench.state().tool.z, kTop);
  EXPECT_LE(bench.ran_on(), bench.sender().run_on().at_most);
}

TEST(AbortLimit, AConverterMayKeepItWhileTheMillHasNoRoom) {
  const std::string job = cuts(60);
  const Profile profile = test_profile();
  const Timeline timeline(job, profile, kMidway);
  AbortBench bench(job, timeline, mill_of("toggle", Flow::rts), {.streaming = jobs::Streaming::full},
                   {.shows_cts = true, .converter = 512});
  bench.run_for(seconds(3));
  bench.abort();
  bench.run_for(seconds(5));
  EXPECT_EQ(bench.sender().state(), jobs::SenderState::aborted);
  EXPECT_LT(bench.state().tool.z, kTop);
  bench.finish();
  EXPECT_EQ(bench.state().tool.z, kTop);
  EXPECT_EQ(bench.state().rpm, 0);
}

// The sender cannot detect that VIEW has stopped the spindle.
TEST(AbortLimit, ASpindleThatViewStoppedTurnsForTheRaise) {
  const std::string job = cuts(400);
  const Profile profile = test_profile();
  const Timeline timeline(job, profile, kMidway);
  AbortBench bench(job, timeline, mill_of("toggle"), {}, {});
  bench.run_for(seconds(20));
  bench.press_view();
  bench.run_for(seconds(5));
  bench.abort();
  bench.run_for(seconds(5));
  bench.press_view();
  bench.finish();
  EXPECT_TRUE(bench.raise_started_spindle());
  EXPECT_EQ(bench.state().rpm, 0);
  EXPECT_EQ(bench.state().tool.z, kTop);
}

// The first move is then 500 mm, longer than in the Timeline.
TEST(AbortLimit, AToolThatBeginsElsewhereIsLater) {
  const std::string job = cuts(400);
  const Profile profile = test_profile();
  const Timeline timeline(job, profile, kMidway);
  AbortBench bench(job, timeline, mill_of("in-band"), {.buffer = 512}, {}, "!MC0;PU50000,0;!MC1;");
  bench.run_for(seconds(30));
  bench.abort();
  bench.finish();
  EXPECT_GT(bench.ran_on(), bench.sender().run_on().at_most);
  EXPECT_LE(bench.ran_on(), bench.sender().run_on().if_held);
  EXPECT_EQ(bench.state().tool.z, kTop);
}

}  // namespace
}  // namespace axisgate::rml1::abort_guard_test
