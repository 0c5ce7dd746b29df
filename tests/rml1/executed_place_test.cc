// Tests of the place that is reported after an abort: up to where the mill has executed the job.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "device/rml1/sending/commands.h"
#include "tests/rml1/mill_controller_fixture.h"

namespace axisgate::rml1::executed_place_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::StartsWith;

// Returns the range of the executed place in `body` after execution of `executed` and writing of `written`. Both are
// beginnings of `body`.
jobs::PlaceRange range(const std::string& body, const std::string& executed, const std::string& written) {
  const PreparedJob job(body, "d1", test_profile(), std::nullopt, jobs::SendSettings());
  const std::size_t before = prologue().size();
  return job.executed(executed.empty() ? 0 : before + executed.size(), before + written.size());
}

TEST(ExecutedPlace, IsWhereTheNextCommandBegins) {
  const std::string body = "PU1,1;\r\nPD2,2; \nPD3,3;PU;";
  EXPECT_EQ(range(body, "PU1,1;", "PU1,1;\r\nPD2,2; \n"), (jobs::PlaceRange{{8, 2, 1}, {16, 3, 1}}));
  EXPECT_EQ(range(body, "PU1,1;\r\nPD2,2;", "PU1,1;\r\nPD2,2; \nPD3,3;"), (jobs::PlaceRange{{16, 3, 1}, {22, 3, 7}}));
}

// In "PD2,2PD3,3", the second P ends the first command.
TEST(ExecutedPlace, OfACommandThatTheNextOneEnds) {
  EXPECT_EQ(range("PD2,2PD3,3;", "PD2,2P", "PD2,2PD3,3;"), (jobs::PlaceRange{{5, 1, 6}, {11, 1, 12}}));
}

TEST(ExecutedPlace, OfAListIsTheNextSetOfCoordinates) {
  EXPECT_EQ(range("PD1,2,3,4,5,6;", "PD1,2,", "PD1,2,3,4,"), (jobs::PlaceRange{{6, 1, 7}, {10, 1, 11}}));
}

TEST(ExecutedPlace, BeforeTheFirstAndBehindTheLast) {
  EXPECT_EQ(range("PU1,1;PD2,2;", "", ""), (jobs::PlaceRange{{0, 1, 1}, {0, 1, 1}}));
  EXPECT_EQ(range("PU1,1;\nPD2,2;\n", "PU1,1;\nPD2,2;", "PU1,1;\nPD2,2;\n;PU;"),
            (jobs::PlaceRange{{14, 3, 1}, {14, 3, 1}}));
}

// Everything written has been executed: the next command does not begin before the end of the written bytes.
TEST(ExecutedPlace, IsNeverBehindWhatIsWritten) {
  EXPECT_EQ(range("PU1,1;\n\nPD2,2;", "PU1,1;", "PU1,1;\n"), (jobs::PlaceRange{{8, 3, 1}, {8, 3, 1}}));
}

TEST(ExecutedPlace, OfARestCountsFromTheBeginningOfItsFile) {
  const std::string body = "!PZ-100,200;\nPU1,1;\nPU2,2;\nPU3,3;";
  const Result<Approach> approach = approach_to(body, body.find("PU2,2"), test_profile(), std::nullopt);
  ASSERT_TRUE(approach);
  const PreparedJob rest(body, "d1", test_profile(), std::nullopt, jobs::SendSettings(), 0, approach->at, *approach);
  const std::size_t begins = prologue().size() + approach->words.size();
  EXPECT_EQ(rest.executed(prologue().size() + 1, begins), (jobs::PlaceRange{{20, 3, 1}, {20, 3, 1}}))
      << "on the way there";
  EXPECT_EQ(rest.executed(begins + 6, begins + 7), (jobs::PlaceRange{{27, 4, 1}, {27, 4, 1}}));
}

class ExecutedPlaceTest : public MillControllerTest {
 protected:
  void begin(const std::vector<jobs::JobPart>& parts = {}) {
    jobs::Job job{.number = 1, .name = "part.rml", .owner = "unix anna", .setup = setup()};
    job.bytes = vectors(20).size();
    job.parts = parts;
    mill_.add(std::move(job), now_);
    run_job(1);
  }
  const std::optional<jobs::PlaceRange>& executed() const { return mill_.jobs().front().executed; }
};

// By test_profile() the spindle starts in 2 s and a move takes 0.9 s. By the slack of SendSettings the slowest mill
// takes half as long again: at 5.7 s it has executed V, VS and two moves, which are 24 bytes.
TEST_F(ExecutedPlaceTest, IsKnownWhenAnAbortIsRequestedAndSaidWhenItWasSent) {
  begin();
  run_for(5900ms);
  ASSERT_FALSE(executed());
  mill_.abort({.who = "unix bert"}, now_);
  ASSERT_TRUE(executed());
  EXPECT_EQ(executed()->least, (jobs::Place{24, 1, 25}));
  EXPECT_EQ(executed()->most.offset, noted_);
  const std::size_t column = noted_ + 1;
  run_for(1s);
  EXPECT_EQ(said_.back(), fmt::format("ABORTED: the abort was sent; by the mill's profile what was executed ends "
                                      "between line 1, column 25 and line 1, column {}",
                                      column));
}

// A person may have pressed VIEW: by its profile the mill would have executed more in a minute than it has. All bytes
// that have left the host fit into the mill's buffer.
TEST_F(ExecutedPlaceTest, IsNotByTheProfileWhereTheLineIsStopped) {
  begin();
  run_for(5900ms);
  line_.busy = true;
  run_for(60s);
  ASSERT_LT(line_.received.size(), settings_.sending.buffer);
  mill_.abort({.who = "unix bert"}, now_);
  ASSERT_TRUE(executed());
  EXPECT_EQ(executed()->least, (jobs::Place{0, 1, 1}));
  EXPECT_EQ(executed()->most.offset, noted_);
}

// The mill may have discarded, by the second abort, bytes that its model has executed since the first.
TEST_F(ExecutedPlaceTest, TheFirstAbortCounts) {
  begin();
  run_for(2500ms);
  line_.busy = true;
  mill_.abort({.who = "unix bert"}, now_);
  const jobs::PlaceRange first = *executed();
  run_for(100ms);
  ASSERT_EQ(state(1), jobs::JobState::running) << "the abort does not leave";
  mill_.abort({.who = "unix carl"}, now_);
  EXPECT_EQ(executed(), first);
}

TEST_F(ExecutedPlaceTest, OfAPartIsSaidOfWhich) {
  begin({{"T1", vectors(20).size()}, {"T2", vectors(20).size() + 10}});
  mill_.abort({.who = "unix bert"}, now_);
  run_for(1s);
  EXPECT_THAT(said_.back(),
              StartsWith("ABORTED: the abort was sent; by the mill's profile what was executed of part 1 ends "));
}

TEST_F(ExecutedPlaceTest, AStartForgetsAnAbortThatWasLost) {
  begin();
  run_for(2500ms);
  line_.busy = true;
  mill_.abort({.who = "unix bert"}, now_);
  mill_.link_down(now_, "unplugged");
  ASSERT_EQ(state(1), jobs::JobState::paused_unknown);
  ASSERT_TRUE(executed());
  ASSERT_TRUE(mill_.choose_rest(1, {jobs::Place()}, "unix anna", now_));
  line_.busy = false;
  mill_.link_up(now_);
  run_for(1s);
  ASSERT_TRUE(mill_.confirm(1, mill_.jobs().front().setup, "unix bert", now_));
  const auto rest = std::make_shared<const PreparedJob>(vectors(20), "d1", profile_, std::nullopt, settings_.sending, 0,
                                                        jobs::Place());
  ASSERT_TRUE(mill_.start(1, rest, {.who = "unix anna"}, now_));
  EXPECT_FALSE(executed());
}

}  // namespace
}  // namespace axisgate::rml1::executed_place_test
