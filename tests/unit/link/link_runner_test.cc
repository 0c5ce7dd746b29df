#include <sys/socket.h>

#include <future>
#include <thread>

#include "device/link/clock.h"
#include "device/link/descriptor.h"
#include "device/link/pty.h"
#include "device/link/runner.h"
#include "device/link/serial_port.h"
#include "device/link/socket_pair.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::link_runner_test {
namespace {

using link_test::EventLoop;
using link_test::read_now;
using link_test::RecordingMachine;
using link_test::send_now;
using std::chrono::milliseconds;
using testing::Test;

class RunnerTest : public Test {
 protected:
  // Refuses as often as `refusals_` says, then opens a new socket pair and keeps its far end.
  OpenedLine open() {
    ++openings_;
    if (refusals_ > 0) {
      --refusals_;
      return fail(Reason::link_down, "serial port /dev/none: no such device", "Check the cable.");
    }
    const auto pair = open_socket_pair();
    EXPECT_TRUE(pair);
    far_.push_back(Descriptor(pair->device));
    return Descriptor(pair->host);
  }

  void start() {
    runner_.attach(machine_);
    runner_.start();
  }

  bool up(std::size_t times = 1) {
    return loop_.run_until([&] { return machine_.count("up") == times; });
  }
  bool down(std::size_t times = 1) {
    return loop_.run_until([&] { return machine_.count("down") == times; });
  }
  int far() { return far_.back().get(); }

  bool far_reads(std::string_view expected) {
    std::string got;
    return loop_.run_until([&] {
      got += read_now(far());
      return got.size() >= expected.size();
    }) && got == expected;
  }

  EventLoop loop_;
  int openings_ = 0;
  int refusals_ = 0;
  std::vector<Descriptor> far_;
  Runner runner_{loop_.strand(), opener_on_strand([this] { return open(); })};
  RecordingMachine machine_{runner_};
};

TEST_F(RunnerTest, HandsBytesBothWays) {
  start();
  ASSERT_TRUE(up());
  send_now(far(), "*IDN?\r\n");
  EXPECT_TRUE(far_reads("*IDN?\r\n"));
  EXPECT_EQ(machine_.received, "*IDN?\r\n");
}

TEST_F(RunnerTest, SaysWhyTheLineDoesNotOpenAndLeavesTheBackoffToTheMachine) {
  refusals_ = 2;
  machine_.on_down = [&](TimePoint) { machine_.link().reopen(milliseconds(1)); };
  start();
  ASSERT_TRUE(up());
  EXPECT_EQ(machine_.count("down"), 2u);
  EXPECT_EQ(machine_.reason, "serial port /dev/none: no such device. Check the cable.");
  EXPECT_EQ(openings_, 3);
}

TEST_F(RunnerTest, DoesNotReopenByItself) {
  refusals_ = 1;
  start();
  ASSERT_TRUE(down());
  loop_.run_ready();
  EXPECT_EQ(openings_, 1);
}

TEST_F(RunnerTest, TellsOfALostLineOnce) {
  start();
  ASSERT_TRUE(up());
  far_.back().reset();
  ASSERT_TRUE(down());
  loop_.run_ready();
  EXPECT_EQ(machine_.heard, (std::vector<std::string>{"up", "down"}));
  EXPECT_EQ(machine_.reason, "the line was closed at its other end");
}

TEST_F(RunnerTest, WritesInOrderThoughTheLineIsSlow) {
  start();
  ASSERT_TRUE(up());
  std::string expected;
  for (int i = 0; expected.size() < Runner::kOutputBytesMax - 100; ++i) expected += std::to_string(i) + "\r\n";
  const int small = 1;
  runner_.post([&](TimePoint) {
    for (std::size_t at = 0; at < expected.size(); at += 777) runner_.write(std::string_view(expected).substr(at, 777));
  });
  ::setsockopt(far(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  std::string got;
  std::array<char, 5000> piece;
  ASSERT_TRUE(loop_.run_until([&] {
    const ssize_t size = ::read(far(), piece.data(), piece.size());
    if (size > 0) got.append(piece.data(), static_cast<std::size_t>(size));
    return got.size() >= expected.size();
  }));
  EXPECT_EQ(got, expected);
  EXPECT_EQ(machine_.count("down"), 0u);
}

TEST_F(RunnerTest, ALineThatTakesNothingIsLost) {
  start();
  ASSERT_TRUE(up());
  const std::string piece(Runner::kOutputBytesMax / 2, 'x');
  ASSERT_TRUE(loop_.run_until([&] {
    runner_.post([&](TimePoint) { runner_.write(piece); });
    return machine_.count("down") == 1;
  }));
  EXPECT_EQ(machine_.reason, "the line takes no bytes: its output queue is full");
}

TEST_F(RunnerTest, WritingToAGoneSocketIsALossAndEndsNoProcess) {
  start();
  ASSERT_TRUE(up());
  runner_.post([&](TimePoint) {
    far_.back().reset();
    runner_.write("G:1\r\n");
  });
  EXPECT_TRUE(down());
}

TEST_F(RunnerTest, AdvancesAtTheDeadlineAndNotBefore) {
  start();
  ASSERT_TRUE(up());
  const TimePoint due = monotonic_now() + milliseconds(30);
  runner_.post([&](TimePoint) { machine_.deadline = due; });
  ASSERT_TRUE(loop_.run_until([&] { return !machine_.advanced.empty(); }));
  EXPECT_GE(machine_.advanced.front(), due);
  EXPECT_EQ(machine_.advanced.size(), 1u);
}

TEST_F(RunnerTest, AnEarlierDeadlineTakesTheLaterOnesPlace) {
  start();
  ASSERT_TRUE(up());
  const TimePoint far_off = monotonic_now() + std::chrono::hours(1);
  runner_.post([&](TimePoint) { machine_.deadline = far_off; });
  runner_.post([&](TimePoint now) { machine_.deadline = now + milliseconds(5); });
  ASSERT_TRUE(loop_.run_until([&] { return !machine_.advanced.empty(); }));
  EXPECT_LT(machine_.advanced.front(), far_off);
}

TEST_F(RunnerTest, AWithdrawnDeadlineIsNotCalled) {
  start();
  ASSERT_TRUE(up());
  TimePoint withdrawn;
  runner_.post([&](TimePoint now) { machine_.deadline = withdrawn = now + milliseconds(5); });
  runner_.post([&](TimePoint) { machine_.deadline.reset(); });
  ASSERT_TRUE(loop_.run_until([&] { return monotonic_now() > withdrawn + milliseconds(20); }));
  EXPECT_TRUE(machine_.advanced.empty());
}

TEST_F(RunnerTest, ReopeningForgetsWhatTheOldLineHeld) {
  start();
  ASSERT_TRUE(up());
  runner_.post([&](TimePoint) {
    send_now(far(), "late reply\r\n");
    runner_.write("never sent\r\n");
    runner_.reopen(milliseconds(1));
  });
  ASSERT_TRUE(up(2));
  send_now(far(), "new\r\n");
  EXPECT_TRUE(far_reads("new\r\n"));
  EXPECT_EQ(machine_.count("new\r\n"), 1u);
  std::array<char, 8> rest;
  errno = 0;
  const bool nothing_sent = ::recv(far_.front().get(), rest.data(), rest.size(), 0) <= 0;
  EXPECT_TRUE(nothing_sent && errno != EAGAIN) << "the old line is closed";
}

TEST_F(RunnerTest, ReopeningWaitsAsLongAsAsked) {
  start();
  ASSERT_TRUE(up());
  TimePoint asked;
  TimePoint came;
  machine_.on_up = [&](TimePoint now) { came = now; };
  runner_.post([&](TimePoint now) {
    asked = now;
    runner_.reopen(milliseconds(40));
  });
  ASSERT_TRUE(up(2));
  EXPECT_GE(came - asked, milliseconds(40));
}

TEST_F(RunnerTest, TheLastOfSeveralReopeningsCounts) {
  start();
  ASSERT_TRUE(up());
  runner_.post([&](TimePoint) {
    runner_.reopen(std::chrono::hours(1));
    runner_.reopen(milliseconds(1));
  });
  ASSERT_TRUE(up(2));
  EXPECT_EQ(openings_, 2);
}

TEST_F(RunnerTest, AfterShutdownTheMachineHearsNothing) {
  start();
  ASSERT_TRUE(up());
  runner_.post([&](TimePoint now) { machine_.deadline = now + milliseconds(1); });
  bool ran = false;
  runner_.shutdown();
  runner_.post([&](TimePoint) { ran = true; });
  const TimePoint later = monotonic_now() + milliseconds(20);
  ASSERT_TRUE(loop_.run_until([&] { return monotonic_now() > later; }));
  EXPECT_FALSE(ran);
  EXPECT_EQ(machine_.heard, std::vector<std::string>{"up"});
  std::array<char, 8> rest;
  EXPECT_EQ(::recv(far(), rest.data(), rest.size(), 0), 0) << "the line is closed";
}

// Closing a port whose flow control holds bytes back would wait for them, and a held command must not run later.
TEST(RunnerOnATty, ALineThatIsGivenUpDropsWhatItHasNotSent) {
  EventLoop loop;
  const link_test::TemporaryDirectory directory;
  const SerialSettings settings{.path = directory / "tty"};
  const auto pty = open_pty(settings.path);
  ASSERT_TRUE(pty) << pty.error().message;
  Runner runner(loop.strand(),
                opener_on_thread([&] { return open_serial(settings).map([](int port) { return Descriptor(port); }); }));
  RecordingMachine machine(runner);
  runner.attach(machine);
  runner.start();
  ASSERT_TRUE(loop.run_until([&] { return machine.count("up") == 1; }));
  const std::string piece(1024, 'x');
  ASSERT_TRUE(loop.run_until([&] {
    runner.post([&](TimePoint) { runner.write(piece); });
    return machine.count("down") == 1;
  }));
  // Up to one page, which the master's end of the pseudo terminal has already taken, cannot be withdrawn.
  EXPECT_LE(read_now(pty->master()).size(), 4096u);
}

TEST(RunnerLifetime, HandlersThatOutliveTheRunnerDoNothing) {
  EventLoop loop;
  const auto pair = open_socket_pair();
  ASSERT_TRUE(pair);
  const Descriptor far(pair->device);
  auto runner =
      std::make_unique<Runner>(loop.strand(), opener_on_strand([&]() -> OpenedLine { return Descriptor(pair->host); }));
  RecordingMachine machine(*runner);
  runner->attach(machine);
  runner->start();
  ASSERT_TRUE(loop.run_until([&] { return machine.count("up") == 1; }));
  send_now(far.get(), "Q:\r\n");
  runner->post([](TimePoint) { FAIL() << "ran after the end"; });
  runner.reset();
  loop.run_ready();
  EXPECT_EQ(machine.received, "");
}

TEST(LineInsideTheProcess, HostTalksToADeviceAndMayOpenItAgain) {
  EventLoop loop;
  Runner device_runner(loop.strand());
  RecordingMachine device(device_runner);
  device_runner.attach(device);
  device_runner.start();
  Runner host_runner(loop.strand(), line_to(device_runner));
  RecordingMachine host(host_runner);
  host.echo = false;
  host_runner.attach(host);
  host.on_up = [&](TimePoint) { host_runner.write("first"); };
  host_runner.start();
  ASSERT_TRUE(loop.run_until([&] { return host.received == "first"; }));

  host.on_up = [&](TimePoint) { host_runner.write("second"); };
  host_runner.post([&](TimePoint) { host_runner.reopen(milliseconds(1)); });
  ASSERT_TRUE(loop.run_until([&] { return host.received == "firstsecond"; }));
  EXPECT_EQ(device.heard, (std::vector<std::string>{"up", "first", "down", "up", "second"}));
}

// Sends questions and counts answers; reopens the line after every hundredth answer.
class AskingMachine : public LineMachine {
 public:
  AskingMachine(Runner& runner, std::function<void()> finished) : runner_(runner), finished_(std::move(finished)) {}

  void link_up(TimePoint) override { runner_.write("?"); }
  void link_down(TimePoint, std::string_view) override { runner_.reopen(milliseconds(0)); }
  void receive(std::string_view, TimePoint now) override {
    deadline_ = now;
    if (++answers_ == kAnswers) finished_();
  }
  void advance(TimePoint) override {
    if (!std::exchange(deadline_, std::nullopt) || answers_ == kAnswers) return;
    if (answers_ % 100 == 0) {
      runner_.reopen(milliseconds(0));
    } else {
      runner_.write("?");
    }
  }
  std::optional<TimePoint> next_deadline() const override { return deadline_; }

 private:
  static constexpr int kAnswers = 2000;
  Runner& runner_;
  std::function<void()> finished_;
  std::optional<TimePoint> deadline_;
  int answers_ = 0;
};

TEST(LineInsideTheProcess, EachEndHasItsStrandAndTheThreadsAreShared) {
  boost::asio::io_context context(2);
  auto work = boost::asio::make_work_guard(context);
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) threads.emplace_back([&] { context.run(); });

  Runner device_runner(boost::asio::make_strand(context));
  RecordingMachine device(device_runner);
  device_runner.attach(device);
  Runner host_runner(boost::asio::make_strand(context), line_to(device_runner));
  std::promise<void> finished;
  AskingMachine host(host_runner, [&] { finished.set_value(); });
  host_runner.attach(host);
  device_runner.start();
  host_runner.start();

  EXPECT_EQ(finished.get_future().wait_for(link_test::kPatience), std::future_status::ready);
  host_runner.shutdown();
  device_runner.shutdown();
  work.reset();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(device.received, std::string(2000, '?'));
}

TEST(MonotonicNow, NeverRunsBackwards) {
  TimePoint last = monotonic_now();
  for (int i = 0; i < 10'000; ++i) {
    const TimePoint now = monotonic_now();
    ASSERT_GE(now, last);
    last = now;
  }
}

}  // namespace
}  // namespace axisgate::link_runner_test
