// Tests of the simulated mill's buffer, its flow control, and ESC.K by each interpretation (guideline 4).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1::simulator::line_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr char kEscapeK[] = "\x1B.K";

MillSetup with_buffer(std::size_t bytes, Flow flow = Flow::none) {
  MillSetup setup;
  setup.buffer_bytes = bytes;
  setup.flow = flow;
  return setup;
}

// Keeps the mill busy for 2 s of spin-up and 1 s of travel, with nothing buffered.
void keep_busy(MillBench& bench) { bench.send("PU1500,0;"); }

TEST(MillBuffer, HoldsWhatComesDuringAMotion) {
  MillBench bench;
  keep_busy(bench);
  bench.send("PU0,0;");
  EXPECT_EQ(bench.mill.state(bench.now).buffered, 6u);
  bench.wait_ms(2999);
  EXPECT_EQ(bench.mill.state(bench.now).buffered, 6u);
  bench.wait_ms(1);
  EXPECT_EQ(bench.mill.state(bench.now).buffered, 0u);
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 5000");
}

TEST(MillBuffer, IsFilledBeyondItsEndOnlyWithAnError) {
  MillBench bench(with_buffer(16));
  keep_busy(bench);
  bench.send("PU1000,0;PU900,0");  // 16 bytes
  EXPECT_EQ(bench.errors(), "none");
  bench.send(";PU0,0;");
  EXPECT_EQ(bench.errors(), "16");
  EXPECT_EQ(bench.mill.state(bench.now).buffered, 16u);
  bench.finish();
  // The last command has lost its end.
  EXPECT_EQ(bench.tool(), "1000 0 5000");
}

TEST(MillBuffer, StopsAndReleasesTheHostByXoff) {
  MillBench bench(with_buffer(16, Flow::xon));
  keep_busy(bench);
  bench.send("PU1000,0;PU");
  EXPECT_EQ(bench.written, "");
  EXPECT_FALSE(bench.mill.holds_back());
  bench.send("0");  // three quarters
  EXPECT_EQ(bench.written, "\x13");
  EXPECT_TRUE(bench.mill.holds_back());
  bench.wait_ms(2999);
  EXPECT_EQ(bench.written, "\x13");
  bench.wait_ms(1);
  EXPECT_EQ(bench.written, "\x13\x11");
  EXPECT_FALSE(bench.mill.holds_back());
}

TEST(MillBuffer, ReleasesTheHostWhenHalfIsFree) {
  MillBench half(with_buffer(16, Flow::xon)), less(with_buffer(16, Flow::xon));
  keep_busy(half);
  keep_busy(less);
  half.send("PU1,0;   PU1,1;");  // 6 of 15 bytes are read, 9 wait for the travel to X 1
  half.wait_ms(3000);
  EXPECT_EQ(half.mill.state(half.now).buffered, 9u);
  EXPECT_EQ(half.written, "\x13");
  less.send("PU1,0;  PU1,1;");
  less.wait_ms(3000);
  EXPECT_EQ(less.mill.state(less.now).buffered, 8u);
  EXPECT_EQ(less.written, "\x13\x11");
}

TEST(MillBuffer, StopsTheHostByCtsWithoutAByte) {
  MillBench bench(with_buffer(16, Flow::rts));
  keep_busy(bench);
  bench.send("PU1000,0;PU0");
  EXPECT_TRUE(bench.mill.holds_back());
  bench.finish();
  EXPECT_FALSE(bench.mill.holds_back());
  EXPECT_EQ(bench.written, "");
}

TEST(MillBuffer, HoldsNothingBackWithoutFlowControl) {
  MillBench bench(with_buffer(16));
  keep_busy(bench);
  bench.send("PU1000,0;PU900,0");
  EXPECT_FALSE(bench.mill.holds_back());
}

TEST(MillEscape, PassesOnWhatIsNoSequence) {
  MillBench bench;
  bench.send("!MC0;PU500\x1BPU600,0;PU\x1B");  // ESC ends a list (2-2 [Delimiter])
  bench.finish();
  EXPECT_EQ(bench.tool(), "600 0 5000");
  EXPECT_EQ(bench.errors(), "2");
}

TEST(MillEscape, ShowsError11AndReadsTheLetter) {
  MillBench bench;
  bench.send("!MC0;\x1B.PU700,0;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "700 0 5000");
  EXPECT_EQ(bench.errors(), "11");
}

TEST(MillEscape, KeepsTheFirstErrorOfTheLine) {
  MillBench bench(with_buffer(16));
  bench.send("\x1B.;");
  keep_busy(bench);
  bench.send("PU1000,0;PU900,0;;");
  EXPECT_EQ(bench.errors(), "11");
  EXPECT_THAT(bench.recorded("error"), ElementsAre("\"error\":11", "\"error\":16", "\"error\":16"));
}

// Sends ESC.K during a travel of 15 mm at 15 mm/s, with 6 bytes buffered.
void escape_in_mid_move(MillBench& bench) {
  bench.send("!MC0;F15;PU1500,0;");
  bench.send("PU0,0;");
  bench.wait_ms(400);
  bench.send(kEscapeK);
}

TEST(MillEscapeK, AsToggleDiscardsUntilTheNext) {
  MillBench bench;
  escape_in_mid_move(bench);
  EXPECT_EQ(bench.tool(), "600 0 5000");
  bench.send("PU0,700;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "600 0 5000");
  EXPECT_TRUE(bench.mill.state(bench.now).discarding);
  bench.send(kEscapeK);
  bench.send("PU0,800;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 800 5000");
  EXPECT_THAT(bench.recorded("discarded"),
              ElementsAre("\"discarded\":6,\"by\":\"escape_k\"", "\"discarded\":8,\"by\":\"escape_k\""));
}

TEST(MillEscapeK, AsOneShotDiscardsWhatIsBuffered) {
  MillBench bench(with_options({{"escape_k", "one-shot"}}));
  escape_in_mid_move(bench);
  EXPECT_EQ(bench.tool(), "600 0 5000");
  bench.send("PU0,700;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 700 5000");
}

TEST(MillEscapeK, InBandComesAfterWhatIsBuffered) {
  MillBench bench(with_options({{"escape_k", "in-band"}}));
  escape_in_mid_move(bench);
  EXPECT_EQ(bench.mill.state(bench.now).buffered, 9u);
  bench.send("PU0,700;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 5000");
  bench.send(kEscapeK);
  bench.send("PU0,800;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 800 5000");
}

// A pair leaves every interpretation in the same state.
TEST(MillEscapeK, TwiceIsTheSameInEveryInterpretation) {
  for (const char* interpretation : {"toggle", "one-shot", "in-band"}) {
    MillBench bench(with_options({{"escape_k", interpretation}}));
    escape_in_mid_move(bench);
    bench.send(kEscapeK);
    bench.send("PU0,800;");
    bench.finish();
    EXPECT_EQ(bench.tool(), "0 800 5000") << interpretation;
    EXPECT_FALSE(bench.mill.state(bench.now).discarding) << interpretation;
  }
}

TEST(MillEscapeK, EndsTheCommandThatIsNotWholeYet) {
  MillBench bench(with_options({{"escape_k", "one-shot"}}));
  bench.send("!MC0;PU500,50");
  bench.send(kEscapeK);
  bench.send("0;PU;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 5000");
  EXPECT_EQ(bench.errors(), "2");
}

TEST(MillEscapeK, InBandEndsTheCommandThatIsNotWholeYet) {
  MillBench bench(with_options({{"escape_k", "in-band"}}));
  bench.send("!MC0;PU500,50");
  bench.send(kEscapeK);
  bench.send(kEscapeK);
  bench.send(";");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 5000");
}

TEST(MillEscapeK, EndsACircumflex) {
  MillBench bench(with_options({{"escape_k", "one-shot"}}));
  bench.send("!MC0;^");
  bench.send(kEscapeK);
  bench.send("D;");  // D of mode 1: after ^ it would not be a command
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -100");
  EXPECT_EQ(bench.errors(), "none");
}

TEST(MillEscapeK, LeavesTheSpindleTurning) {
  MillBench bench(with_options({{"escape_k", "one-shot"}}));
  keep_busy(bench);
  bench.wait_ms(2400);
  bench.send(kEscapeK);
  EXPECT_EQ(bench.mill.state(bench.now).rpm, 6500);
  // Relative movement counts from the place where the tool stopped.
  bench.send("PR100,0;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "700 0 5000");
}

TEST(MillEscapeK, MayBeLostWithAFullBuffer) {
  for (const auto& [when_full, expected] : {std::pair("taken", "none"), std::pair("dropped", "16")}) {
    MillBench bench(with_options({{"escape_k_when_full", when_full}}, with_buffer(16)));
    keep_busy(bench);
    bench.send("PU1000,0;PU900,0");
    bench.send(kEscapeK);
    EXPECT_EQ(bench.errors(), expected);
  }
  MillBench in_band(with_options({{"escape_k", "in-band"}}, with_buffer(16)));
  keep_busy(in_band);
  in_band.send("PU1000,0;PU900");
  in_band.send(kEscapeK);
  EXPECT_EQ(in_band.errors(), "16");
}

TEST(MillEscapeK, IsNotTakenWithASmallLetter) {
  MillBench bench;
  keep_busy(bench);
  bench.send("\x1B.k");
  bench.finish();
  EXPECT_EQ(bench.tool(), "1500 0 5000");
  EXPECT_EQ(bench.errors(), "1,11");  // k is not a command
}

}  // namespace
}  // namespace axisgate::rml1::simulator::line_test
