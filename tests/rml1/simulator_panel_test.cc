// Tests of a person's actions at the simulated mill, directly and as lines of its control socket.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/core/control_language.h"
#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1::simulator::panel_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string say(MillBench& bench, std::string_view line) { return control_reply(bench.mill.operate(line, bench.now)); }

// Lowers the tool, then runs 400 ms of a cut of 15 mm at 15 mm/s, 100 steps below Z0.
void cut(MillBench& bench) {
  bench.send("V15;F15;PD;");
  bench.finish();
  bench.send("PD1500,0;PD0,0;");
  bench.wait_ms(400);
}

TEST(MillView, TakesEffectAfterTheMoveAndContinues) {
  MillBench bench;
  cut(bench);
  EXPECT_EQ(say(bench, "view"), "ok");
  EXPECT_EQ(bench.tool(), "600 0 -100");
  bench.wait_ms(600);
  EXPECT_EQ(bench.mill.state(bench.now).rpm, 0);
  bench.finish();
  EXPECT_EQ(bench.tool(), "1500 0 5000");
  EXPECT_THAT(say(bench, "state"), HasSubstr("buffered=6 errors=none moving=no paused=view"));

  // 5100 steps at 15 mm/s up again, the spin-up, and the cut of 15 mm.
  const TimePoint before = bench.now;
  EXPECT_EQ(say(bench, "view"), "ok");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -100");
  EXPECT_EQ(bench.now - before, std::chrono::milliseconds(2000 + 3400 + 1000));
  EXPECT_THAT(bench.recorded("panel"), ElementsAre("\"panel\":\"view\"", "\"panel\":\"view released\""));
}

TEST(MillView, MayTakeEffectAtOnceAndStay) {
  MillBench bench(with_options({{"view_takes_effect", "at-once"}, {"pause_position", "stays"}}));
  cut(bench);
  bench.mill.press_view(bench.now);
  bench.finish();
  EXPECT_EQ(bench.tool(), "600 0 -100");
  bench.mill.press_view(bench.now);
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -100");
}

TEST(MillView, MayDiscardWhatIsBuffered) {
  MillBench bench(with_options({{"view_data", "discarded"}}));
  cut(bench);
  bench.mill.press_view(bench.now);
  bench.finish();
  bench.mill.press_view(bench.now);
  bench.finish();
  EXPECT_EQ(bench.tool(), "1500 0 -100");
}

TEST(MillView, PressedDuringTheReturnRaisesAgainAndComesBackToTheSamePlace) {
  MillBench bench(with_options({{"view_takes_effect", "at-once"}}));
  cut(bench);
  bench.mill.press_view(bench.now);
  bench.finish();
  bench.mill.press_view(bench.now);
  bench.wait_ms(2500);  // half a second into the return
  bench.mill.press_view(bench.now);
  bench.finish();
  EXPECT_EQ(bench.tool(), "600 0 5000");
  bench.mill.press_view(bench.now);
  bench.wait_ms(2000 + 3400);
  EXPECT_EQ(bench.tool(), "600 0 -100");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -100");
}

// !NR "effects a paused state"; "this can only be canceled using the control panel" (guideline 3-3).
TEST(MillView, EndsThePauseOfNr) {
  MillBench bench;
  bench.send("!MC0;PU500,0;!NR;PU0,0;");
  bench.finish();
  EXPECT_THAT(say(bench, "state"), HasSubstr("x=500 y=0 z=5000"));
  EXPECT_THAT(say(bench, "state"), HasSubstr("paused=not-ready"));
  say(bench, "view");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 5000");
}

TEST(MillCover, StopsTheToolAtOnceUntilItIsClosed) {
  MillBench bench;
  cut(bench);
  EXPECT_EQ(say(bench, "cover open"), "ok");
  EXPECT_EQ(bench.mill.state(bench.now).rpm, 0);
  bench.finish();
  EXPECT_EQ(bench.tool(), "600 0 5000");
  EXPECT_EQ(bench.mill.state(bench.now).paused, "cover");
  EXPECT_EQ(say(bench, "cover closed"), "ok");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -100");
}

TEST(MillCover, MayEndTheJobOrDoNothing) {
  MillBench ends(with_options({{"cover_open", "ends"}}));
  cut(ends);
  ends.mill.set_cover(true, ends.now);
  ends.mill.set_cover(false, ends.now);
  ends.finish();
  EXPECT_THAT(ends.tool(), testing::StartsWith("600 0 "));
  MillBench ignored(with_options({{"cover_open", "ignored"}}));
  cut(ignored);
  ignored.mill.set_cover(true, ignored.now);
  ignored.finish();
  EXPECT_EQ(ignored.tool(), "0 0 -100");
}

TEST(MillStop, EndsTheCommandAndDiscardsTheBuffer) {
  MillBench bench;
  cut(bench);
  EXPECT_EQ(say(bench, "stop"), "ok");
  bench.finish();
  EXPECT_EQ(bench.tool(), "600 0 -100");
  EXPECT_EQ(bench.mill.state(bench.now).rpm, 0);
  EXPECT_THAT(bench.recorded("discarded"), ElementsAre("\"discarded\":6,\"by\":\"stop\""));
  bench.send("PU;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "600 0 5000");
}

TEST(MillPower, LosesBufferSettingsAndWhatIsSent) {
  MillBench bench;
  cut(bench);
  bench.send("Q;");
  EXPECT_EQ(say(bench, "power off"), "ok");
  bench.send("PU9,9;");
  bench.finish();
  EXPECT_EQ(
      say(bench, "state"),
      "ok x=600 y=0 z=-100 tool=down spindle=0 buffered=0 errors=none moving=no paused=no discarding=no power=off");
  EXPECT_EQ(say(bench, "power on"), "ok");
  // Z at the default speed of 2 mm/s again: 5100 steps.
  EXPECT_NEAR(bench.time_ms("!MC0;PU;"), 25500, 0.001);
  EXPECT_EQ(bench.tool(), "600 0 5000");
}

TEST(MillStop, EndsAPause) {
  MillBench bench;
  cut(bench);
  bench.mill.press_view(bench.now);
  bench.finish();
  bench.mill.press_stop(bench.now);
  EXPECT_EQ(bench.mill.state(bench.now).paused, "no");
  bench.send("PU1,0;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "1 0 5000");
}

TEST(MillPower, ForgetsTheBeginOfASequence) {
  MillBench bench;
  bench.send("\x1B.");
  bench.mill.set_power(false, bench.now);
  bench.mill.set_power(true, bench.now);
  bench.send("K;");
  EXPECT_EQ(bench.errors(), "1");
}

TEST(MillPower, LowersCts) {
  MillSetup setup;
  setup.flow = Flow::rts;
  MillBench bench(setup);
  bench.mill.set_power(false, bench.now);
  EXPECT_TRUE(bench.mill.holds_back());
  bench.mill.set_power(true, bench.now);
  EXPECT_FALSE(bench.mill.holds_back());
}

TEST(MillPower, EndsTheDiscardingOfEscapeK) {
  MillBench bench;
  bench.send("\x1B.KPU;");
  bench.mill.set_power(false, bench.now);
  bench.mill.set_power(true, bench.now);
  bench.send("PU5,5;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "5 5 5000");
  bench.lines.clear();
  bench.send("\x1B.K\x1B.K");
  EXPECT_THAT(bench.recorded("discarded"),
              ElementsAre("\"discarded\":0,\"by\":\"escape_k\"", "\"discarded\":0,\"by\":\"escape_k\""));
}

TEST(MillHeights, OfThePanelAreInEffect) {
  MillBench bench;
  EXPECT_EQ(say(bench, "z1 -300"), "ok");
  EXPECT_EQ(say(bench, "z2 400"), "ok");
  bench.send("!MC0;PD;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -300");
  bench.send("PU;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 400");
}

// @ without numbers: "the value set using the operation panel may be used" (guideline 3-1 @). !PZ without numbers: "the
// default values".
TEST(MillHeights, OfThePanelComeBackByAtAlone) {
  const auto after = [](const std::string& option, const std::string& value, const std::string& job) {
    MillBench bench(with_options({{option, value}}));
    bench.mill.set_z1(-300, bench.now);
    bench.send("!MC0;!PZ-50,200;" + job + ";PD;");
    bench.finish();
    return bench.tool();
  };
  EXPECT_EQ(after("at_without_numbers", "panel", "@"), "0 0 -300");
  EXPECT_EQ(after("at_without_numbers", "profile", "@"), "0 0 -100");
  EXPECT_EQ(after("at_without_numbers", "panel", "!PZ"), "0 0 -100");
  EXPECT_EQ(after("initialized_heights", "profile", "DF"), "0 0 -100");
  EXPECT_EQ(after("initialized_heights", "panel", "DF"), "0 0 -300");
}

TEST(MillHeights, AreJudgedOneByOne) {
  MillBench bench;
  // The bottom is 1050 steps below Z0 (guideline 3-3 !PZ: "Error 3 also results when Z1 is outside the work area").
  bench.send("!MC0;!PZ-1051,700;");
  EXPECT_EQ(bench.errors(), "3");
  bench.send("PU;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 700");
  bench.send("@-1050,-1;PD;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -1050");
  bench.send("PU;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 700");
}

TEST(MillDisplay, IsClearedByHAndIn) {
  MillBench bench;
  bench.send("Q;5;W-1;\x1B.;");
  EXPECT_EQ(bench.errors(), "1,2,3,11");
  bench.send("H;");
  bench.finish();
  EXPECT_EQ(bench.errors(), "11");
  bench.send("^IN;");
  bench.finish();
  EXPECT_EQ(bench.errors(), "none");
}

TEST(MillControl, RefusesWithoutChange) {
  MillBench bench;
  EXPECT_THAT(say(bench, "z1 5"), HasSubstr("error: '5' cannot be used as DEPTH; say: z1 DEPTH (DEPTH -8388608 to 0)"));
  EXPECT_THAT(say(bench, "origin 70000 0"), HasSubstr("error: this is outside of the work area"));
  EXPECT_THAT(say(bench, "z0 1"), HasSubstr("error: this is outside of the work area"));
  EXPECT_THAT(say(bench, "fly"), HasSubstr("there is no command 'fly'; say one of: help, view"));
  EXPECT_EQ(bench.tool(), "0 0 5000");
}

TEST(MillControl, SetsTheOrigin) {
  MillBench bench;
  EXPECT_EQ(say(bench, "origin 0 200"), "ok");
  EXPECT_EQ(say(bench, "z0 -6000"), "ok");
  EXPECT_EQ(bench.tool(), "10000 9800 6000");
}

TEST(MillControl, HelpDescribesEveryCommand) {
  MillBench bench;
  const std::string all = say(bench, "help");
  for (const std::string name : {"view", "cover", "stop", "power", "z1", "z2", "origin", "z0", "state"}) {
    EXPECT_THAT(all, HasSubstr("; " + name));
    EXPECT_THAT(say(bench, "help " + name), testing::StartsWith("ok " + name));
  }
}

}  // namespace
}  // namespace axisgate::rml1::simulator::panel_test
