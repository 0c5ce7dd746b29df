#include <gmock/gmock.h>
#include <netinet/tcp.h>

#include <latch>
#include <memory>

#include "device/link/runner.h"
#include "device/link/tcp_socket.h"
#include "tests/unit/link/link_fixtures.h"
#include "tests/unit/link/tcp_fixtures.h"

namespace axisgate::link_tcp_socket_test {
namespace {

using link_test::EventLoop;
using link_test::read_now;
using link_test::RecordingMachine;
using link_test::send_now;
using link_test::SerialServer;
using link_test::SilentHost;
using std::chrono::milliseconds;
using testing::HasSubstr;

class TcpSocketTest : public testing::Test {
 protected:
  // Returns the result of one attempt to open.
  OpenedLine open(const TcpSettings& settings) {
    std::optional<OpenedLine> result;
    const Opener opener = tcp_opener(settings);
    const Opening opening = opener(loop_.strand(), [&](OpenedLine line) { result.emplace(std::move(line)); });
    EXPECT_FALSE(result) << "the answer comes after the call";
    EXPECT_TRUE(loop_.run_until([&] { return result.has_value(); }));
    return result ? *std::move(result) : fail(Reason::internal, "no answer");
  }

  static int option_of(const Descriptor& socket, int level, int option) {
    int value = -1;
    socklen_t size = sizeof value;
    EXPECT_EQ(::getsockopt(socket.get(), level, option, &value, &size), 0);
    return value;
  }

  EventLoop loop_;
};

TEST_F(TcpSocketTest, ConnectsAndNoticesAHalfOpenLine) {
  const SerialServer server;
  const OpenedLine line = open(server.settings());
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_NE(::fcntl(line->get(), F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(option_of(*line, IPPROTO_TCP, TCP_NODELAY), 1);
  EXPECT_EQ(option_of(*line, IPPROTO_TCP, TCP_USER_TIMEOUT), 5000);
  EXPECT_EQ(option_of(*line, SOL_SOCKET, SO_KEEPALIVE), 1);
  EXPECT_EQ(option_of(*line, IPPROTO_TCP, TCP_KEEPIDLE), 5);
  EXPECT_EQ(option_of(*line, IPPROTO_TCP, TCP_KEEPINTVL), 2);
  EXPECT_EQ(option_of(*line, IPPROTO_TCP, TCP_KEEPCNT), 3);
}

TEST_F(TcpSocketTest, ALookedUpNameConnectsToo) {
  const SerialServer server;
  EXPECT_TRUE(open({"localhost", server.settings().port})) << "::1 refuses, 127.0.0.1 takes it";
}

TEST_F(TcpSocketTest, ARefusedConnectionSaysThatTheLineMayBeTaken) {
  SerialServer server;
  server.close();
  const OpenedLine line = open(server.settings());
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().reason, Reason::link_down);
  EXPECT_EQ(line.error().message, "connection refused by " + to_string(server.settings()));
  EXPECT_THAT(line.error().hint, HasSubstr("one connection"));
}

TEST_F(TcpSocketTest, AnUnknownNameIsSaidToBeOne) {
  const OpenedLine line = open({"no such host", 4001});  // no name contains a blank, so no server is asked
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().message, "no such host is not known");
  EXPECT_THAT(line.error().hint, HasSubstr("spelling"));
}

TEST_F(TcpSocketTest, NoWayThere) {
  const OpenedLine line = open({"255.255.255.255", 4001});
  ASSERT_FALSE(line);
  EXPECT_THAT(line.error().message, testing::StartsWith("255.255.255.255:4001 cannot be reached: "));
}

TEST_F(TcpSocketTest, AHostThatDoesNotAnswerIsGivenUp) {
  const SilentHost host;
  const TimePoint begun = monotonic_now();
  const OpenedLine line = open(host.settings());
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().message, "no answer from " + to_string(host.settings()) + " within 5 s");
  EXPECT_THAT(line.error().hint, HasSubstr("switched on"));
  EXPECT_GE(monotonic_now() - begun, kConnectLimit - milliseconds(1));
}

TEST_F(TcpSocketTest, AnAttemptThatIsLetGoTellsNobodyAndLeavesNoConnection) {
  SerialServer server;
  bool told = false;
  const Opener opener = tcp_opener(server.settings());
  Opening opening = opener(loop_.strand(), [&](const OpenedLine&) { told = true; });
  opening.reset();
  ASSERT_TRUE(open(server.settings())) << "by then the first would have been told, too";
  EXPECT_FALSE(told);
  EXPECT_TRUE(server.accept().valid());
  EXPECT_FALSE(server.accept().valid());
}

TEST_F(TcpSocketTest, DnsNamesAreShownWithTheirPort) {
  EXPECT_EQ(to_string(TcpSettings{"moxa.lab", 4001}), "moxa.lab:4001");
  EXPECT_EQ(to_string(TcpSettings{"fe80::1", 4001}), "[fe80::1]:4001");
}

class TcpRunnerTest : public TcpSocketTest {
 protected:
  void start() {
    runner_.attach(machine_);
    runner_.start();
  }
  bool up(std::size_t times = 1) {
    return loop_.run_until([&] { return machine_.count("up") == times; });
  }
  bool accepted() {
    return loop_.run_until([&] {
      far_ = server_.accept();
      return far_.valid();
    });
  }

  SerialServer server_;
  Descriptor far_;
  Runner runner_{loop_.strand(), tcp_opener(server_.settings())};
  RecordingMachine machine_{runner_};
};

TEST_F(TcpRunnerTest, CarriesBytesBothWaysAndHearsTheEnd) {
  start();
  ASSERT_TRUE(up() && accepted());
  send_now(far_.get(), "OK\r\n");
  std::string echoed;
  ASSERT_TRUE(loop_.run_until([&] { return (echoed += read_now(far_.get())) == "OK\r\n"; }));
  far_.reset();
  ASSERT_TRUE(loop_.run_until([&] { return machine_.count("down") == 1; }));
  EXPECT_EQ(machine_.reason, "the line was closed at its other end");
}

TEST_F(TcpRunnerTest, ReopensWithANewConnection) {
  machine_.on_down = [&](TimePoint) { machine_.link().reopen(milliseconds(1)); };
  start();
  ASSERT_TRUE(up() && accepted());
  far_.reset();
  EXPECT_TRUE(up(2) && accepted());
}

// Data that the other end has not taken may contain a command, which must not run once nobody waits for its answer.
TEST_F(TcpRunnerTest, ALineThatIsGivenUpDropsWhatItHasNotSent) {
  start();
  ASSERT_TRUE(up() && accepted());
  const std::string piece(32 * 1024, 'x');
  std::size_t written = 0;
  ASSERT_TRUE(loop_.run_until([&] {
    runner_.post([&](TimePoint) {
      runner_.write(piece);
      written += piece.size();
    });
    return machine_.count("down") == 1;
  }));
  std::array<char, 65536> buffer;
  std::size_t got = 0;
  ssize_t size = 0;
  ASSERT_TRUE(loop_.run_until([&] {
    while ((size = ::read(far_.get(), buffer.data(), buffer.size())) > 0) got += static_cast<std::size_t>(size);
    return size == 0 || errno != EAGAIN;
  }));
  EXPECT_EQ(size, -1) << "the connection ended as if all had been sent";
  EXPECT_EQ(errno, ECONNRESET);
  EXPECT_LT(got + Runner::kOutputBytesMax, written);
}

TEST_F(TcpRunnerTest, AStopThatAsksForALineBeingOpenedWaitsForThatAttempt) {
  start();
  runner_.post([&](TimePoint) { runner_.reopen(Duration::zero()); });
  ASSERT_TRUE(up() && accepted());
  loop_.run_ready();
  EXPECT_EQ(machine_.count("up"), 1u);
  EXPECT_FALSE(server_.accept().valid()) << "a second connection was made";
}

TEST(OpenerOnThread, AnAttemptThatIsLetGoClosesWhatItOpensLater) {
  EventLoop loop;
  // Shared with the thread, which may still be leaving wait() when the test has ended.
  const auto gate = std::make_shared<std::latch>(1);
  std::array<int, 2> line{};
  ASSERT_EQ(::pipe2(line.data(), O_CLOEXEC | O_NONBLOCK), 0);
  const Opener opener = opener_on_thread([gate, end = line[1]]() -> OpenedLine {
    gate->wait();
    return Descriptor(end);
  });
  Opening opening = opener(loop.strand(), [](const OpenedLine&) { FAIL() << "told all the same"; });
  loop.run_ready();
  opening.reset();
  gate->count_down();
  char byte = 0;
  EXPECT_TRUE(loop.run_until([&] { return ::read(line[0], &byte, 1) == 0; })) << "the writing end is still open";
  ::close(line[0]);
}

}  // namespace
}  // namespace axisgate::link_tcp_socket_test
