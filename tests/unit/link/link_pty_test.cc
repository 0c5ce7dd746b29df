#include <sys/ioctl.h>
#include <termios.h>

#include <fstream>

#include "device/link/pty.h"
#include "device/link/pty_line.h"
#include "device/link/pty_watch.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::link_pty_test {
namespace {

namespace fs = std::filesystem;
using link_test::EventLoop;
using link_test::read_now;
using link_test::RecordingMachine;
using link_test::send_now;
using link_test::TemporaryDirectory;

Descriptor open_client(const std::string& path) {
  Descriptor client(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  EXPECT_TRUE(client.valid());
  return client;
}

TEST(Pty, StandsUnderItsLinkAndTakesItAway) {
  const TemporaryDirectory directory;
  const std::string link = directory / "tty";
  {
    const auto pty = open_pty(link);
    ASSERT_TRUE(pty) << pty.error().message;
    EXPECT_EQ(fs::read_symlink(link), pty->device());
    EXPECT_EQ(pty->device().rfind("/dev/pts/", 0), 0u);
  }
  EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
}

TEST(Pty, ReplacesASymbolicLinkThatLeadsNowhere) {
  const TemporaryDirectory directory;
  const std::string link = directory / "tty";
  fs::create_symlink("/dev/pts/gone", link);
  const auto pty = open_pty(link);
  ASSERT_TRUE(pty) << pty.error().message;
  EXPECT_EQ(fs::read_symlink(link), pty->device());
}

TEST(Pty, LeavesAnythingElseAlone) {
  const TemporaryDirectory directory;
  const std::string link = directory / "notes";
  std::ofstream(link) << "precious";
  const auto pty = open_pty(link);
  ASSERT_FALSE(pty);
  EXPECT_EQ(pty.error().message,
            "pseudo terminal " + link + ": something that is not a symbolic link is already there");
  std::string content;
  std::ifstream(link) >> content;
  EXPECT_EQ(content, "precious");
}

TEST(Pty, SaysWhereTheLinkCannotBeMade) {
  const auto pty = open_pty("/nowhere/tty");
  ASSERT_FALSE(pty);
  EXPECT_EQ(pty.error().message,
            "pseudo terminal /nowhere/tty: the symbolic link cannot be made: No such file or directory");
}

TEST(Pty, LeavesALinkThatNowLeadsElsewhere) {
  const TemporaryDirectory directory;
  const std::string link = directory / "tty";
  {
    const auto first = open_pty(link);
    ASSERT_TRUE(first);
    fs::remove(link);
    fs::create_symlink("/dev/null", link);
  }
  EXPECT_EQ(fs::read_symlink(link), "/dev/null");
}

TEST(Pty, EchoesNothingBeforeAndAfterItsFirstClient) {
  const TemporaryDirectory directory;
  const auto pty = open_pty(directory / "tty");
  ASSERT_TRUE(pty);
  Descriptor client = open_client(pty->device());
  termios mode{};
  ASSERT_EQ(::tcgetattr(client.get(), &mode), 0);
  EXPECT_EQ(mode.c_lflag & (ECHO | ICANON | ISIG), 0u);
  EXPECT_EQ(mode.c_oflag & OPOST, 0u);
}

class PtyLineTest : public testing::Test {
 protected:
  PtyLineTest() {
    line_->attach(machine_);
    line_->start();
    loop_.run_ready();
  }
  ~PtyLineTest() override {
    line_->shutdown();
    loop_.run_ready();
  }

  static std::shared_ptr<PtyLine> make_line(EventLoop& loop, const std::string& link) {
    auto pty = open_pty(link);
    EXPECT_TRUE(pty);
    auto watch = PtyWatch::open(*pty);
    EXPECT_TRUE(watch);
    return std::make_shared<PtyLine>(loop.strand(), std::move(*pty), std::move(*watch));
  }

  Descriptor client() { return open_client(line_->pty().link()); }
  bool hears(std::size_t count) {
    return loop_.run_until([&] { return machine_.heard.size() >= count; });
  }
  bool client_reads(const Descriptor& client, std::string_view expected) {
    std::string got;
    return loop_.run_until([&] {
      got += read_now(client.get());
      return got.size() >= expected.size();
    }) && got == expected;
  }

  TemporaryDirectory directory_;
  EventLoop loop_;
  std::shared_ptr<PtyLine> line_ = make_line(loop_, directory_ / "tty");
  RecordingMachine machine_{*line_};
  using Heard = std::vector<std::string>;
};

TEST_F(PtyLineTest, AnswersAClientAndHearsItComeAndGo) {
  EXPECT_EQ(machine_.heard, Heard{});
  Descriptor first = client();
  ASSERT_TRUE(hears(1));
  send_now(first.get(), "Q:\r\n");
  EXPECT_TRUE(client_reads(first, "Q:\r\n"));
  first.reset();
  ASSERT_TRUE(hears(3));
  EXPECT_EQ(machine_.heard, (Heard{"up", "Q:\r\n", "down"}));
}

TEST_F(PtyLineTest, ServesOneClientAfterAnother) {
  for (int i = 1; i <= 3; ++i) {
    const Descriptor next = client();
    send_now(next.get(), "Q:\r\n");
    EXPECT_TRUE(client_reads(next, "Q:\r\n")) << i;
  }
}

TEST_F(PtyLineTest, TakesWhatAClientWroteThatIsGoneAlready) {
  Descriptor first = client();
  send_now(first.get(), "M:1+P100\r\nG:1\r\n");
  first.reset();
  ASSERT_TRUE(hears(3));
  EXPECT_EQ(machine_.heard, (Heard{"up", "M:1+P100\r\nG:1\r\n", "down"}));
}

TEST_F(PtyLineTest, GivesNoClientItsPredecessorsReplies) {
  Descriptor first = client();
  send_now(first.get(), "for the first\r\n");
  ASSERT_TRUE(hears(2));
  first.reset();
  const Descriptor second = client();
  send_now(second.get(), "Q:\r\n");
  ASSERT_TRUE(hears(5));
  EXPECT_TRUE(client_reads(second, "Q:\r\n"));
}

TEST_F(PtyLineTest, TellsClientsApartThatFollowEachOtherUnseen) {
  Descriptor first = client();
  ASSERT_TRUE(hears(1));
  send_now(first.get(), "?:C");
  first.reset();
  const Descriptor second = client();
  ASSERT_TRUE(hears(4));
  EXPECT_EQ(machine_.heard, (Heard{"up", "?:C", "down", "up"}));
  send_now(second.get(), "Q:\r\n");
  EXPECT_TRUE(client_reads(second, "Q:\r\n"));
}

TEST_F(PtyLineTest, BytesOfASuccessorAreItsOwn) {
  Descriptor first = client();
  ASSERT_TRUE(hears(1));
  first.reset();
  const Descriptor second = client();
  send_now(second.get(), "Q:\r\n");
  EXPECT_TRUE(client_reads(second, "Q:\r\n"));
  EXPECT_EQ(machine_.heard, (Heard{"up", "down", "up", "Q:\r\n"}));
}

// XOFF is sent like a byte but is not reported as written, so it resembles bytes whose writing is reported too late.
TEST_F(PtyLineTest, BytesOfWhichNothingIsToldAreASuccessors) {
  Descriptor first = client();
  send_now(first.get(), "for the first\r\n");
  ASSERT_TRUE(hears(2));
  first.reset();
  const Descriptor second = client();
  ASSERT_EQ(::tcflow(second.get(), TCIOFF), 0);
  ASSERT_TRUE(hears(5));
  EXPECT_EQ(machine_.heard, (Heard{"up", "for the first\r\n", "down", "up", "\x13"}));
}

TEST_F(PtyLineTest, TwoUnseenClientsInARow) {
  Descriptor first = client();
  send_now(first.get(), "first\r\n");
  first.reset();
  const Descriptor second = client();
  ASSERT_TRUE(hears(4));
  EXPECT_EQ(machine_.heard, (Heard{"up", "first\r\n", "down", "up"}));
  EXPECT_EQ(read_now(second.get()), "");
}

TEST_F(PtyLineTest, ASecondOpenerIsNoNewClient) {
  const Descriptor first = client();
  ASSERT_TRUE(hears(1));
  client().reset();
  send_now(first.get(), "Q:\r\n");
  EXPECT_TRUE(client_reads(first, "Q:\r\n"));
  EXPECT_EQ(machine_.heard, (Heard{"up", "Q:\r\n"}));
}

TEST_F(PtyLineTest, AClientThatDoesNotReadHoldsNothingUp) {
  Descriptor idle = client();
  ASSERT_TRUE(hears(1));
  const std::string lines(1000, 'x');
  for (std::size_t sent = lines.size(); sent <= 100 * lines.size(); sent += lines.size()) {
    send_now(idle.get(), lines);
    ASSERT_TRUE(loop_.run_until([&] { return machine_.received.size() == sent; }));
  }
  idle.reset();
  const Descriptor next = client();
  send_now(next.get(), "Q:\r\n");
  ASSERT_TRUE(loop_.run_until([&] { return machine_.heard.back() == "Q:\r\n"; }));
  EXPECT_TRUE(client_reads(next, "Q:\r\n"));
}

TEST_F(PtyLineTest, AClientThatReadsLateGetsEverything) {
  const Descriptor late = client();
  ASSERT_TRUE(hears(1));
  std::string expected;
  for (int number = 0; expected.size() < 200'000; ++number) expected += std::to_string(number) + "\r\n";
  line_->post([&](TimePoint) { line_->write(expected); });
  loop_.run_ready();
  EXPECT_TRUE(client_reads(late, expected));
}

TEST_F(PtyLineTest, BeyondWhatIsKeptEachWriteIsLostAsAWhole) {
  const Descriptor late = client();
  ASSERT_TRUE(hears(1));
  const std::string kept(PtyLine::kBytesUnsentMax, 'k');
  line_->post([&](TimePoint) {
    line_->write(kept);
    for (int i = 0; i < 100; ++i) line_->write(std::string(1000, 'l'));
  });
  loop_.run_ready();
  std::string got;
  ASSERT_TRUE(loop_.run_until([&] {
    got += read_now(late.get());
    return got.size() >= kept.size();
  }));
  send_now(late.get(), "Q:\r\n");
  ASSERT_TRUE(loop_.run_until([&] {
    got += read_now(late.get());
    return got.ends_with("Q:\r\n");
  }));
  EXPECT_EQ((got.size() - kept.size() - 4) % 1000, 0u);
  EXPECT_LT(got.size(), kept.size() + 50'000);
}

TEST_F(PtyLineTest, AClientThatEmptiesItsInputGetsNothingOld) {
  const Descriptor client = this->client();
  ASSERT_TRUE(hears(1));
  line_->post([&](TimePoint) { line_->write(std::string(200'000, 'x')); });
  loop_.run_ready();
  ASSERT_EQ(::tcflush(client.get(), TCIFLUSH), 0);
  send_now(client.get(), "Q:\r\n");
  EXPECT_TRUE(client_reads(client, "Q:\r\n"));
}

TEST_F(PtyLineTest, IsRawAgainAfterAClientThatTurnedEchoOn) {
  Descriptor first = client();
  ASSERT_TRUE(hears(1));
  termios mode{};
  ASSERT_EQ(::tcgetattr(first.get(), &mode), 0);
  mode.c_lflag |= ECHO | ICANON;
  ASSERT_EQ(::tcsetattr(first.get(), TCSANOW, &mode), 0);
  first.reset();
  ASSERT_TRUE(hears(2));
  const Descriptor second = client();
  ASSERT_EQ(::tcgetattr(second.get(), &mode), 0);
  EXPECT_EQ(mode.c_lflag & (ECHO | ICANON), 0u);
}

TEST_F(PtyLineTest, AClientThatReservedItKeepsNobodyOutForever) {
  Descriptor first = client();
  ASSERT_TRUE(hears(1));
  ASSERT_EQ(::ioctl(first.get(), TIOCEXCL), 0);
  first.reset();
  ASSERT_TRUE(hears(2));
  EXPECT_FALSE(line_->pty().is_reserved());
  EXPECT_EQ(fs::read_symlink(line_->pty().link()), line_->pty().device());
  for (int i = 0; i < 2; ++i) {
    const Descriptor next = client();
    send_now(next.get(), "Q:\r\n");
    EXPECT_TRUE(client_reads(next, "Q:\r\n"));
  }
}

TEST_F(PtyLineTest, WritesToNobodyAreLost) {
  line_->post([&](TimePoint) { line_->write("1\r\n"); });
  loop_.run_ready();
  const Descriptor first = client();
  ASSERT_TRUE(hears(1));
  EXPECT_EQ(read_now(first.get()), "");
}

}  // namespace
}  // namespace axisgate::link_pty_test
