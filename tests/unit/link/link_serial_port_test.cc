#include <asm/termbits.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/wait.h>

#include <fstream>

#include "device/link/descriptor.h"
#include "device/link/pty.h"
#include "device/link/serial_port.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::link_serial_port_test {
namespace {

using link_test::read_now;
using link_test::send_now;
using link_test::TemporaryDirectory;

class SerialPortTest : public testing::Test {
 protected:
  SerialPortTest() { settings_.path = directory_ / "tty"; }

  static termios2 mode_of(const Descriptor& port) {
    termios2 mode{};
    EXPECT_EQ(::ioctl(port.get(), TCGETS2, &mode), 0);
    return mode;
  }

  Descriptor open() {
    const auto opened = open_serial(settings_);
    EXPECT_TRUE(opened) << opened.error().message;
    return Descriptor(opened.value_or(-1));
  }

  Problem refusal() {
    const auto opened = open_serial(settings_);
    if (opened) {
      ADD_FAILURE() << "it opened";
      Descriptor(*opened).reset();
      return {};
    }
    EXPECT_EQ(opened.error().reason, Reason::link_down);
    return opened.error();
  }

  TemporaryDirectory directory_;
  SerialSettings settings_;
};

class SerialPortOnPtyTest : public SerialPortTest {
 protected:
  Result<Pty> pty_ = open_pty(settings_.path);
};

TEST_F(SerialPortTest, MissingDevice) {
  EXPECT_EQ(refusal().message, "serial port " + settings_.path + ": no such device");
}

TEST_F(SerialPortTest, NotASerialPort) {
  std::ofstream(settings_.path) << "text";
  EXPECT_EQ(refusal().message, "serial port " + settings_.path + ": not a serial port");
  settings_.path = "/dev/null";
  EXPECT_EQ(refusal().message, "serial port /dev/null: not a serial port");
}

TEST_F(SerialPortTest, PermissionDeniedNamesTheGroup) {
  std::ofstream(settings_.path) << "";
  std::filesystem::permissions(settings_.path, std::filesystem::perms::none);
  const bool root = ::geteuid() == 0;  // permissions do not stop root
  constexpr uid_t kNobody = 65534;
  if (root) {
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  const Problem problem = refusal();
  if (root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  EXPECT_EQ(problem.message, "serial port " + settings_.path + ": permission denied");
  EXPECT_NE(problem.hint.find("group dialout"), std::string::npos);
}

TEST_F(SerialPortTest, SettingsThatCannotBe) {
  settings_.baud = 0;
  EXPECT_EQ(refusal().message, "serial port " + settings_.path + ": 0 is no baud rate");
  settings_.baud = 9600;
  settings_.stop_bits = 3;
  EXPECT_EQ(refusal().message, "serial port " + settings_.path + ": 3 stop bits are not possible");
}

TEST_F(SerialPortOnPtyTest, IsRawAndHasTheUsualSettings) {
  const Descriptor port = open();
  const termios2 mode = mode_of(port);
  EXPECT_EQ(mode.c_ospeed, 38400u);
  EXPECT_EQ(mode.c_cflag & CSIZE, static_cast<tcflag_t>(CS8));
  EXPECT_EQ(mode.c_cflag & (PARENB | CSTOPB), 0u);
  EXPECT_NE(mode.c_cflag & CRTSCTS, 0u);
  EXPECT_EQ(mode.c_lflag & (ECHO | ICANON | ISIG), 0u);
  EXPECT_EQ(mode.c_oflag & OPOST, 0u);
  EXPECT_EQ(mode.c_iflag & (ICRNL | IXON), 0u);
  EXPECT_NE(::fcntl(port.get(), F_GETFL) & O_NONBLOCK, 0);
}

TEST_F(SerialPortOnPtyTest, TakesAnyRate) {
  for (const int baud : {9600, 12345, 31250, 250000, 1500000, 4000000}) {
    settings_.baud = baud;
    const Descriptor port = open();
    // The other end is checked, because the port itself would only repeat the settings.
    termios2 seen{};
    ASSERT_EQ(::ioctl(pty_->master(), TCGETS2, &seen), 0);
    EXPECT_EQ(seen.c_ospeed, static_cast<speed_t>(baud));
    EXPECT_EQ(seen.c_ispeed, static_cast<speed_t>(baud));
  }
}

TEST_F(SerialPortOnPtyTest, TakesTheOtherSettings) {
  settings_.flow = FlowControl::none;
  settings_.stop_bits = 2;
  settings_.parity = Parity::even;  // ignored by a pseudo terminal, which has no bits to check
  const Descriptor port = open();
  EXPECT_EQ(mode_of(port).c_cflag & CRTSCTS, 0u);
  EXPECT_NE(mode_of(port).c_cflag & CSTOPB, 0u);
}

// The device's RTS arrives as CTS, and its DTR as DSR.
TEST(SerialPort, TheLineThatForbidsIsThatOfTheFlowControl) {
  struct Row {
    FlowControl flow;
    int lines;
    bool forbidden;
  };
  constexpr int kOthers = TIOCM_DTR | TIOCM_RTS | TIOCM_CAR | TIOCM_RNG;
  for (const Row& row : {
           Row{FlowControl::rts_cts, kOthers | TIOCM_CTS, false},
           Row{FlowControl::rts_cts, kOthers | TIOCM_DSR, true},
           Row{FlowControl::rts_cts, kOthers, true},
           Row{FlowControl::dtr_dsr, kOthers | TIOCM_DSR, false},
           Row{FlowControl::dtr_dsr, kOthers | TIOCM_CTS, true},
           Row{FlowControl::dtr_dsr, kOthers, true},
           Row{FlowControl::xon_xoff, 0, false},
           Row{FlowControl::none, 0, false},
       }) {
    EXPECT_EQ(forbids(row.flow, row.lines), row.forbidden)
        << "flow control " << static_cast<int>(row.flow) << ", lines " << row.lines;
  }
}

// The driver does not support DTR/DSR.
TEST_F(SerialPortOnPtyTest, DtrDsrIsWithoutTheDriver) {
  settings_.flow = FlowControl::dtr_dsr;
  const Descriptor port = open();
  EXPECT_EQ(mode_of(port).c_cflag & CRTSCTS, 0u);
  EXPECT_EQ(mode_of(port).c_iflag & IXON, 0u);
}

TEST_F(SerialPortOnPtyTest, WithoutModemLinesNothingIsHeld) {
  const Descriptor port = open();
  EXPECT_FALSE(is_held(port.get(), FlowControl::rts_cts));
  EXPECT_FALSE(is_held(port.get(), FlowControl::dtr_dsr));
}

TEST_F(SerialPortOnPtyTest, ForgetsWhatCameBeforeItWasOpen) {
  const Descriptor early(::open(settings_.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
  send_now(pty_->master(), "old\r\n");
  pollfd waiting{early.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&waiting, 1, 10'000), 1);
  const Descriptor port = open();
  EXPECT_EQ(read_now(port.get()), "");
  send_now(pty_->master(), "new\r\n");
  waiting.fd = port.get();
  ASSERT_EQ(::poll(&waiting, 1, 10'000), 1);
  EXPECT_EQ(read_now(port.get()), "new\r\n");
}

TEST_F(SerialPortOnPtyTest, CanBeOpenedAgainAfterItWasClosed) {
  open().reset();
  EXPECT_TRUE(open().valid());
}

TEST_F(SerialPortOnPtyTest, H33_OpenTwiceInThisProcessIsRefused) {
  const Descriptor first = open();
  EXPECT_EQ(refusal().message.rfind("serial port " + settings_.path + ": held by another process", 0), 0u);
}

TEST_F(SerialPortOnPtyTest, H33_HeldByAnotherProcessNamesIt) {
  std::array<int, 2> ready{}, release{};
  ASSERT_EQ(::pipe(ready.data()), 0);
  ASSERT_EQ(::pipe(release.data()), 0);
  const pid_t holder = ::fork();
  if (holder == 0) {
    const int port = ::open(settings_.path.c_str(), O_RDWR | O_NOCTTY);
    char byte = ::flock(port, LOCK_EX | LOCK_NB) == 0 ? 'y' : 'n';
    ::close(release[1]);
    if (::write(ready[1], &byte, 1) == 1) (void)!::read(release[0], &byte, 1);
    ::_exit(0);
  }
  char held = 'n';
  ASSERT_EQ(::read(ready[0], &held, 1), 1);
  ASSERT_EQ(held, 'y');
  const termios2 before = mode_of(Descriptor(::open(settings_.path.c_str(), O_RDWR | O_NOCTTY)));
  settings_.baud = 57600;
  EXPECT_EQ(refusal().message,
            "serial port " + settings_.path + ": held by another process (pid " + std::to_string(holder) + ")");
  const termios2 after = mode_of(Descriptor(::open(settings_.path.c_str(), O_RDWR | O_NOCTTY)));
  EXPECT_EQ(after.c_ospeed, before.c_ospeed) << "the holder's settings are untouched";
  for (const int end : {release[1], release[0], ready[0], ready[1]}) ::close(end);
  EXPECT_EQ(::waitpid(holder, nullptr, 0), holder);
  EXPECT_TRUE(open().valid());
}

}  // namespace
}  // namespace axisgate::link_serial_port_test
