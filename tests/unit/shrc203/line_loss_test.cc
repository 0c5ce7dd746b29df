// A line that is lost, missing or shut out, and how it comes back. The bytes are from the manual.
#include "tests/unit/shrc203/line_fixture.h"

namespace axisgate::shrc203::line_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LineLossTest : public LineFixture {};

TEST_F(LineLossTest, AnotherProgramOnTheLineEndsIt) {
  open_and_rest();
  ask("O:1");
  script({{"O:1\r\n", "OK\r\n"}});
  pass(seconds(1));
  const auto waiting = ask("O:2");
  script({{"?:CMD\r\n", "M:1+P1000\r\n"}});
  EXPECT_THAT(news(), ElementsAre(HasSubstr("lost: the controller was last sent \"M:1+P1000\", and not from here")));
  EXPECT_FALSE(waiting->written());
  EXPECT_EQ(waiting->reason(), Reason::link_down);
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250)));
}

TEST_F(LineLossTest, ALineLostInFlightLeavesItsOutcomeUnknown) {
  open_and_rest();
  const auto in_flight = ask("G:1"), waiting = ask("?:V"), stop = ask("L:1");
  EXPECT_EQ(sent(), "G:1\r\n");
  link_down("unplugged");
  EXPECT_TRUE(in_flight->result->in_doubt());
  EXPECT_EQ(in_flight->reason(), Reason::link_down);
  EXPECT_EQ(in_flight->message(), "the line to the controller is down: unplugged");
  EXPECT_FALSE(waiting->written());
  EXPECT_EQ(waiting->reason(), Reason::link_down);
  ASSERT_EQ(listener.exchanges.size(), 1u);
  EXPECT_EQ(listener.exchanges[0].outcome, ExchangeEnded::Outcome::link_lost);
  EXPECT_EQ(listener.exchanges[0].line, "G:1");
  EXPECT_THAT(news(), ElementsAre("lost: unplugged"));
  EXPECT_FALSE(line.exchanging());
  EXPECT_FALSE(stop->written()) << "who wants it, asks again at the next connect";
}

TEST_F(LineLossTest, NothingWaitsForALineThatIsDown) {
  open_and_rest();
  link_down("unplugged");
  for (const char* text : {"?:V", "L:1"}) {
    const auto refused = ask(text);
    EXPECT_FALSE(refused->written()) << text;
    EXPECT_EQ(refused->reason(), Reason::link_down) << text;
  }
}

TEST_F(LineLossTest, OpenStopsGoBeforeTheFirstProbe) {
  open_and_rest();
  link_down("unplugged");
  line.open_at_once(now);
  line.open_at_once(now);
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), Duration::zero())) << "at once, and once";
  listener.open_stops = {"L:1", "L:2"};
  link_up();
  EXPECT_EQ(sent(), "L:1\r\nL:2\r\n*IDN?\r\n");
  listener.open_stops = {"L:W"};
  receive("OK\r\n");
  EXPECT_EQ(sent(), "L:W\r\n?:CMD\r\n") << "before anything else, and the barrier begins again";
  listener.open_stops = {};
  receive("OK\r\n");
  EXPECT_EQ(sent(), "");
}

TEST_F(LineLossTest, APortIsReopenedWithoutGrowingPausesWhileAStopIsOpen) {
  open_and_rest();
  listener.stop_open = true;
  for (int loss = 0; loss < 3; ++loss) link_down("unplugged");
  listener.stop_open = false;
  for (int loss = 0; loss < 3; ++loss) link_down("unplugged");
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), milliseconds(250), milliseconds(250), milliseconds(250),
                                         milliseconds(500), milliseconds(1000)));
}

// The limit is half of what the line carries in a second, 500 bytes.
TEST_F(LineLossTest, H62_ADeviceThatSendsWithoutEndIsShutOut) {
  open_and_rest();
  const std::string noise(100, 'x');
  for (int i = 0; i < 4; ++i) receive(noise + "\r\n");
  EXPECT_EQ(line.state().phase(), LinkPhase::up);
  pass(seconds(1));
  for (int i = 0; i < 4; ++i) receive(noise + "\r\n");
  EXPECT_EQ(line.state().phase(), LinkPhase::up) << "the second before does not count";
  receive(noise + "\r\n");
  EXPECT_EQ(line.state().phase(), LinkPhase::babbling);
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250)));
  link_up();
  forget();
  EXPECT_EQ(line.state().phase(), LinkPhase::listening);
  receive(std::string(2000, 'x'));
  EXPECT_EQ(line.state().phase(), LinkPhase::babbling);
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), milliseconds(500)));
}

TEST_F(LineLossTest, AnswersAreNoFlood) {
  open_and_rest();
  for (int i = 0; i < 200; ++i) {
    ask("?:V");
    script({{"?:V\r\n", "V2.00.000\r\n"}});
  }
  EXPECT_EQ(line.state().phase(), LinkPhase::up);
}

TEST_F(LineLossTest, ThreeProbesWithoutAnswerCloseTheLine) {
  link_up();
  for (int probe = 1; probe <= 3; ++probe) {
    EXPECT_EQ(sent(), "*IDN?\r\n");
    EXPECT_THAT(link.reopened, IsEmpty());
    pass(kProbeLimit);
  }
  EXPECT_EQ(sent(), "");
  EXPECT_THAT(listener.limits, ElementsAre("probe", "probe", "probe"));
  EXPECT_THAT(news(), ElementsAre("lost: no answer to three probes"));
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250)));
}

TEST_F(LineLossTest, TheWaitDoublesUpToFiveSecondsAndBeginsAnewOnceTheLineIsOpen) {
  for (int i = 0; i < 7; ++i) {
    link_up();
    pass(3 * kProbeLimit);
  }
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), milliseconds(500), seconds(1), seconds(2), seconds(4),
                                         seconds(5), seconds(5)));
  link.reopened.clear();
  link_up();
  receive(std::string(kIdentity) + "\r\n");
  pass(kProbeLimit);
  link_down("an identity is not enough");
  link_up();
  receive(std::string(kIdentity) + "\r\n");
  pass(kProbeLimit);
  open();
  link_down("unplugged");
  EXPECT_THAT(link.reopened, ElementsAre(seconds(5), milliseconds(250)));
  forget();
}

TEST_F(LineLossTest, APortThatDoesNotOpenIsTriedEverMoreSlowly) {
  link_down("no such device");
  link_down("no such device");
  link_down("no such device");
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), milliseconds(500), seconds(1)));
  EXPECT_THAT(news(), ElementsAre("lost: no such device", "lost: no such device", "lost: no such device"));
}

// The half line belongs to the lost connection, and must not become part of a later answer.
TEST_F(LineLossTest, HalfALineIsGoneWithTheLine) {
  open_and_rest();
  ask("?:V");
  receive("V2.0");
  link_down("unplugged");
  link_up();
  forget();
  receive(std::string(kIdentity) + "\r\n");
  pass(kProbeLimit);
  EXPECT_THAT(news(), ElementsAre("connected 2106001001"));
}

}  // namespace
}  // namespace axisgate::shrc203::line_test
