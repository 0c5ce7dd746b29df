// Tests of the gateway with a second machine that is sent jobs, which is known to server/ only by the list of kinds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "server/api/api.h"
#include "server/api/request/names.h"
#include "server/kinds.h"
#include "server/spool/spool.h"
#include "tests/api/world.h"
#include "tests/echo/kind.h"

namespace axisgate::api {
namespace {

using jobs::JobState;
using testing::HasSubstr;

constexpr const char* kEcho = "devices/echo";

server::DeviceKinds kinds_with_echo() {
  static const std::vector<const jobs::Kind*> mills = {&echo::kind()};
  return {.stages = server::device_kinds().stages, .mills = mills};
}

class EchoMachineTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(directory_);
    auto config = server::parse_config(
        "[[device]]\nname = \"echo\"\nkind = \"echo\"\nconnection = \"simulated\"\nstreaming = \"paced\"\n",
        "echo.toml", kinds_with_echo());
    ASSERT_TRUE(config) << to_string(config.error().front());
    config->journal = {.kept = false};
    access_ =
        std::make_unique<server::Access>(server::AccessConfig{}, kAdmin, *server::Tokens::open(directory_ + "/tokens"));
    positions_ = *server::SavedPositions::open(directory_ + "/positions");
    spool_ = *server::spool::Spool::open(directory_ + "/spool", {});
    gateway_ = std::make_unique<server::Gateway>(*config, 1, "", nullptr, spool_.get());
    api_ = std::make_unique<Api>(*gateway_, *access_, *positions_);
    gateway_->start();
    ASSERT_TRUE(comes_true([this] { return newest()->link == jobs::MachineLink::open; }));
  }
  ~EchoMachineTest() override {
    api_.reset();
    gateway_.reset();
    spool_.reset();
    std::filesystem::remove_all(directory_);
  }

  server::Mill& machine() { return dynamic_cast<server::Mill&>(*gateway_->devices().front()); }
  std::shared_ptr<const server::MillNow> newest() { return machine().newest().get().value; }

  Result<CurrentJob> send(const std::string& text) {
    auto upload = api_->mill.sending.send(call_, kEcho,
                                          {.title = "text", .origin = "", .parts = {{"T1"}}, .accepted_warnings = {}});
    if (!upload) return tl::unexpected(upload.error());
    if (const Result<void> taken = (*upload)->append(text); !taken) return tl::unexpected(taken.error());
    Asking<CurrentJob> asking;
    (*upload)->finish("", asking.answer());
    return asking.get();
  }
  Result<CurrentJob> confirm(const jobs::Job& job) {
    Asking<CurrentJob> asking;
    api_->mill.waiting.confirm(call_, job_name("echo", job.number), job.setup, asking.answer());
    return asking.get();
  }
  Result<CurrentJob> start(jobs::JobNumber job) {
    Asking<CurrentJob> asking;
    api_->mill.starts.start(call_, job_name("echo", job), asking.answer());
    return asking.get();
  }
  bool is_in(jobs::JobNumber job, JobState state) {
    return comes_true([&] {
      const auto now = newest();
      if (now->ended && now->ended->number == job) return now->ended->state == state;
      const auto found = std::ranges::find(now->jobs, job, &jobs::Job::number);
      return found != now->jobs.end() && found->state == state;
    });
  }
  jobs::Job started(const std::string& text) {
    const Result<CurrentJob> sent = send(text);
    EXPECT_TRUE(sent) << sent.error().message;
    if (!sent) return {};
    const Result<CurrentJob> confirmed = confirm(sent->job);
    EXPECT_TRUE(confirmed) << confirmed.error().message;
    const Result<CurrentJob> started = start(sent->job.number);
    EXPECT_TRUE(started) << started.error().message;
    return sent->job;
  }
  std::string count() {
    Asking<std::string> asking;
    api_->simulators.operate(call_, kEcho, "count", asking.answer());
    return asking.get().value_or("no answer");
  }

  const std::string directory_ = testing::TempDir() + "axisgate-echo-" + std::to_string(::getpid());
  const Call call_{.credential = {.who = kAdmin}};
  std::unique_ptr<server::Access> access_;
  std::unique_ptr<server::SavedPositions> positions_;
  std::unique_ptr<server::spool::Spool> spool_;
  std::unique_ptr<server::Gateway> gateway_;
  std::unique_ptr<Api> api_;
};

TEST_F(EchoMachineTest, ExecutesAJobThatAPersonConfirms) {
  const jobs::Job job = started("one\ntwo\nthree\n");
  EXPECT_EQ(job.parts.front().takes, (jobs::TimeRange{std::chrono::milliseconds(60), std::chrono::milliseconds(120)}));
  EXPECT_TRUE(is_in(job.number, JobState::fed));
  EXPECT_EQ(count(), "3");
  Asking<CurrentJob> done;
  api_->mill.waiting.done(call_, job_name("echo", job.number), done.answer());
  EXPECT_TRUE(done.get());
  EXPECT_TRUE(is_in(job.number, JobState::done));
}

TEST_F(EchoMachineTest, ExecutesNoMoreThanOneLineAfterAnAbort) {
  std::string text;
  for (int i = 0; i < 500; ++i) text += "line " + std::to_string(i) + "\n";
  const jobs::Job job = started(text);
  ASSERT_TRUE(comes_true([this] { return count() != "0"; }));
  Asking<CurrentRun> aborted;
  api_->mill.mills.abort(call_, kEcho, aborted.answer());
  EXPECT_TRUE(aborted.get());
  EXPECT_TRUE(is_in(job.number, JobState::aborted));
  const int at_abort = std::stoi(count());
  EXPECT_LT(at_abort, 500);
  const jobs::Job next = started("after\n");
  EXPECT_TRUE(is_in(next.number, JobState::fed));
  EXPECT_EQ(std::stoi(count()), at_abort + 1);
}

TEST_F(EchoMachineTest, RefusesJobsThatItsOwnCheckRefuses) {
  const Result<CurrentJob> wrong = send("one\n\ttwo\n");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("line 2, column 1: error: a byte that is no printable ASCII [lines]"));
  EXPECT_THAT(send("one\ntwo").error().message, HasSubstr("open-line: line 2, column 1: the last line has no LF"));
}

TEST_F(EchoMachineTest, StartsNothingThatNobodyHasConfirmed) {
  const Result<CurrentJob> sent = send("one\n");
  ASSERT_TRUE(sent);
  EXPECT_EQ(start(sent->job.number).error().reason, Reason::not_confirmed);
  EXPECT_EQ(count(), "0");
}

}  // namespace
}  // namespace axisgate::api
