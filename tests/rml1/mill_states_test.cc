// Tests of a mill's state machines: every state with every event, typed from the tables in device/jobs/README.md
// and device/rml1/sending/README.md, and the effect of an event that a table lacks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "device/jobs/job_queue.h"
#include "device/rml1/sending/commands.h"
#include "tests/rml1/mill_controller_fixture.h"
#include "tests/unit/core/reported.h"
#include "tests/unit/core/transition_table.h"

namespace axisgate::rml1::mill_states_test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing_tables::illegal_pairs;
using testing_tables::Table;

TEST(JobTable, EachPairLeadsWhereThePageSays) {
  const std::string e = "-";
  const Table table = {
      {"QUEUED", {"CONFIRMED", e, e, e, e, e, e, e, e, e, e, e, e, "CANCELLED", "EXPIRED"}},
      {"CONFIRMED",
       {"CONFIRMED", "QUEUED", "TOOL_CHANGE", "PAUSED", "RUNNING", e, e, e, e, e, e, e, e, "CANCELLED", e}},
      {"RUNNING",
       {e, e, e, e, e, "PAUSED", e, "TOOL_CHANGE", "FED", "ABORTED", "PAUSED_UNKNOWN", "PAUSED_UNKNOWN", e, e, e}},
      {"TOOL_CHANGE", {"CONFIRMED", e, e, e, e, e, e, e, e, e, e, e, e, "CANCELLED", e}},
      {"PAUSED", {"CONFIRMED", e, e, e, e, e, "PAUSED", e, e, e, e, e, e, "CANCELLED", e}},
      {"FED", {e, e, e, e, e, e, e, e, e, e, e, e, "DONE", e, e}},
      {"PAUSED_UNKNOWN", {e, e, e, e, e, e, "PAUSED", e, e, e, e, e, e, "CANCELLED", e}},
      {"DONE", std::vector<std::string>(15, e)},
      {"ABORTED", std::vector<std::string>(15, e)},
      {"CANCELLED", std::vector<std::string>(15, e)},
      {"EXPIRED", std::vector<std::string>(15, e)},
  };
  const int illegal = illegal_pairs<jobs::JobState, jobs::JobEvent>(
      table, jobs::kJobStates,
      {"confirm", "void", "void, later part", "void, rest", "start", "raised", "choose rest", "part fed", "fed",
       "aborted", "abort unsure", "lost", "done", "cancel", "expire"},
      [](jobs::JobState state, jobs::JobEvent event) { return next(state, event); });
  EXPECT_EQ(illegal, 142);
}

TEST(AbortTable, EachPairLeadsWhereThePageSays) {
  const Table table = {
      {"none", {"waits", "leaves", "-", "-", "none"}},
      {"waits", {"waits", "leaves", "-", "-", "waits"}},
      {"leaves", {"-", "leaves", "travels", "-", "waits"}},
      {"travels", {"-", "leaves", "-", "none", "waits"}},
  };
  const int illegal = illegal_pairs<AbortPhase, AbortEvent>(
      table, kAbortPhases, {"postponed", "written", "left", "arrived", "line_lost"},
      [](AbortPhase phase, AbortEvent event) { return next(phase, event); });
  EXPECT_EQ(illegal, 8);
}

TEST(SenderTable, EachPairLeadsWhereThePageSays) {
  const std::string e = "-";
  const Table table = {
      {"READY", {"SENDING", e, e, e, e, e, e, e, "LOST"}},
      {"SENDING", {e, "PAUSED", e, "RAISING", "FINISHING", e, "ABORTING", e, "LOST"}},
      {"PAUSED", {e, e, "SENDING", "RAISING", e, e, "ABORTING", e, "LOST"}},
      {"FINISHING", {e, e, e, e, e, "FED", "ABORTING", e, "LOST"}},
      {"RAISING", {e, e, e, e, e, "RAISED", "ABORTING", e, "LOST"}},
      {"ABORTING", {e, e, e, e, e, e, e, "ABORTED", "LOST"}},
      {"FED", std::vector<std::string>(9, e)},
      {"RAISED", std::vector<std::string>(9, e)},
      {"ABORTED", std::vector<std::string>(9, e)},
      {"LOST", std::vector<std::string>(9, e)},
  };
  const int illegal = illegal_pairs<jobs::SenderState, SendEvent>(
      table, jobs::kSenderStates,
      {"start", "pause", "resume", "raise", "all_written", "all_executed", "abort", "abort_left", "line_lost"},
      [](jobs::SenderState state, SendEvent event) { return next(state, event); });
  EXPECT_EQ(illegal, 71);
}

class Silent : public jobs::QueueEvents {
 public:
  void job_changed(const jobs::Job&, std::string_view, std::string_view, TimePoint) override {}
  void rank_changed(const jobs::Job&) override {}
};

TEST(JobQueue, AnIllegalEventIsReportedAndChangesNothing) {
  Reported reported;
  Silent silent;
  const jobs::SetupLeft left;
  jobs::JobQueue queue(left, std::chrono::days(14), silent, reported);
  const TimePoint now{1000s};
  queue.add({.number = 1, .name = "part.rml"}, now);
  queue.change(queue.at(1), jobs::JobEvent::fed, "", "", now);
  EXPECT_THAT(reported.all, ElementsAre("job QUEUED fed"));
  EXPECT_EQ(queue.at(1).state, jobs::JobState::queued);
  EXPECT_EQ(queue.broken_invariant(), "");
}

TEST(Abort, AnIllegalEventIsReportedAndChangesNothing) {
  Reported reported;
  FakeMillLine line;
  const Profile profile = test_profile();
  const jobs::SendSettings settings;
  Abort abort(profile, settings, line, reported);
  abort.write(true, TimePoint{1000s});
  abort.postpone();
  EXPECT_THAT(reported.all, ElementsAre("abort leaves postponed"));
  EXPECT_EQ(abort.phase(), AbortPhase::leaves);
}

// Each violated invariant must be reported.
TEST(JobQueue, ItsInvariantsSayWhatDoesNotHold) {
  Reported reported;
  Silent silent;
  const jobs::SetupLeft left;
  const auto broken = [&](std::vector<jobs::Job> jobs) {
    jobs::JobQueue queue(left, std::chrono::days(14), silent, reported);
    for (jobs::Job& job : jobs) {
      const jobs::JobState state = std::exchange(job.state, jobs::JobState::queued);
      queue.add(job, TimePoint{1000s});
      queue.at(job.number).state = state;
    }
    return queue.broken_invariant();
  };
  const jobs::Confirmation confirmation{"unix bert", TimePoint{2000s}};
  EXPECT_EQ(broken({{.number = 1, .state = jobs::JobState::running}, {.number = 2}}), "");
  EXPECT_THAT(broken({{.number = 1, .state = jobs::JobState::done}}), HasSubstr("has ended, and is in the queue"));
  EXPECT_THAT(broken({{.number = 1, .state = jobs::JobState::confirmed}}),
              HasSubstr("CONFIRMED and has no confirmation"));
  EXPECT_THAT(broken({{.number = 1, .confirmation = confirmation}}), HasSubstr("QUEUED and has a confirmation"));
  EXPECT_EQ(broken({{.number = 1, .state = jobs::JobState::confirmed, .confirmation = confirmation},
                    {.number = 2, .state = jobs::JobState::confirmed, .confirmation = confirmation}}),
            "two jobs are confirmed");
  EXPECT_EQ(broken({{.number = 1, .state = jobs::JobState::running}, {.number = 2, .state = jobs::JobState::running}}),
            "two jobs run");
  EXPECT_THAT(broken({{.number = 1}, {.number = 2, .state = jobs::JobState::fed}}), HasSubstr("order of is_before()"));
}

// An internal error leaves the mill's activity unknown.
class InternalErrorAtAMill : public MillControllerTest {
 protected:
  void internal_error(std::string_view what, TimePoint) override { errors_.emplace_back(what); }
  void report() { mill_.violations().illegal("job", "QUEUED", "fed"); }

  std::vector<std::string> errors_;
};

TEST_F(InternalErrorAtAMill, AbortsTheJobAndOpensTheLineAgain) {
  add(1);
  run_job(1);
  run_for(100ms);
  line_.writes.clear();
  report();
  EXPECT_FALSE(mill_.is_idle());
  EXPECT_TRUE(mill_.abort_waits()) << "a daemon that ends now keeps it for the next run";
  ASSERT_TRUE(mill_.next_deadline());
  EXPECT_LE(*mill_.next_deadline(), now_) << "at once";
  mill_.advance(now_);
  EXPECT_THAT(errors_, ElementsAre("an internal error: job in state QUEUED cannot have the event fed"));
  EXPECT_EQ(state(1), jobs::JobState::paused_unknown);
  EXPECT_EQ(mill_.running_job(), 0u);
  EXPECT_EQ(line_.reopened, 1);
  EXPECT_EQ(written(), "") << "it would be lost with the line";
  EXPECT_TRUE(mill_.abort_waits());
  mill_.link_up(now_);
  EXPECT_EQ(written(), abort_commands(profile_, true));
  run_for(1s);
  EXPECT_TRUE(mill_.cancel(1, "unix bert", now_)) << "a person has looked";
}

TEST_F(InternalErrorAtAMill, WithTheLineClosedTheAbortWaits) {
  mill_.link_down(now_, "unplugged");
  report();
  mill_.advance(now_);
  EXPECT_EQ(errors_.size(), 1u);
  EXPECT_EQ(line_.reopened, 1) << "once, for the loss";
  mill_.link_up(now_);
  EXPECT_EQ(written(), abort_commands(profile_, true));
}

TEST_F(InternalErrorAtAMill, WithoutAJobTheMillIsAbortedToo) {
  report();
  EXPECT_FALSE(mill_.is_idle());
  mill_.advance(now_);
  mill_.link_up(now_);
  EXPECT_EQ(written(), abort_commands(profile_, true));
  EXPECT_EQ(reason(mill_.operate(jobs::JogStep{.x = {{1, 0}, Unit::millimeters}}, {.who = "unix anna"}, now_)
                       .map([](Duration) {})),
            Reason::axis_busy)
      << "the tool may still rise";
}

TEST_F(InternalErrorAtAMill, TheFirstOfSeveralIsReported) {
  report();
  mill_.violations().illegal("abort", "none", "left");
  mill_.advance(now_);
  EXPECT_THAT(errors_, ElementsAre("an internal error: job in state QUEUED cannot have the event fed"));
}

}  // namespace
}  // namespace axisgate::rml1::mill_states_test
