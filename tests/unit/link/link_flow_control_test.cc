// Flow control of a tty as a Runner shows it to its machine: XOFF, and a modem line that the test simulates.
#include <sys/ioctl.h>

#include <string>
#include <string_view>

#include "device/link/descriptor.h"
#include "device/link/pty.h"
#include "device/link/runner.h"
#include "device/link/serial_port.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::link_flow_control_test {
namespace {

using link_test::EventLoop;
using link_test::read_now;
using link_test::RecordingMachine;
using link_test::send_now;

// After an XOFF from the device, written bytes stay here until it sends XON or flow control is ignored.
TEST(RunnerOnATty, BytesThatXoffHoldsAreUnsent) {
  EventLoop loop;
  const link_test::TemporaryDirectory directory;
  const SerialSettings settings{.path = directory / "tty", .flow = FlowControl::xon_xoff};
  const auto pty = open_pty(settings.path);
  ASSERT_TRUE(pty) << pty.error().message;
  Runner runner(loop.strand(),
                opener_on_thread([&] { return open_serial(settings).map([](int port) { return Descriptor(port); }); }));
  RecordingMachine machine(runner);
  runner.attach(machine);
  runner.start();
  ASSERT_TRUE(loop.run_until([&] { return machine.count("up") == 1; }));
  // The kernel processes an XOFF on its own thread, so bytes are written one by one until one is held.
  const auto hold = [&] {
    send_now(pty->master(), "\x13");
    return loop.run_until([&] {
      if (runner.unsent() == 0) runner.post([&](TimePoint) { runner.write("."); });
      return runner.unsent() == 1;
    });
  };
  const auto comes = [&](std::string_view end) {
    std::string all;
    return loop.run_until([&] { return (all += read_now(pty->master())).ends_with(end) && runner.unsent() == 0; });
  };
  ASSERT_TRUE(hold());
  runner.post([&](TimePoint) { runner.write("PU;"); });
  ASSERT_TRUE(loop.run_until([&] { return runner.unsent() == 4; }));
  send_now(pty->master(), "\x11");
  EXPECT_TRUE(comes(".PU;"));
  ASSERT_TRUE(hold());
  runner.post([&](TimePoint) { runner.write("PD;"); });
  runner.post([&](TimePoint) { runner.ignore_flow_control(true); });
  EXPECT_TRUE(comes(".PD;"));
  EXPECT_FALSE(runner.held()) << "a pseudo terminal has no CTS";
  runner.shutdown();
  loop.run_ready();
}

// A pseudo terminal has no DSR, so the test simulates it.
TEST(RunnerOnATty, IsHeldWhileDsrIsLowAndNotIgnored) {
  EventLoop loop;
  const link_test::TemporaryDirectory directory;
  const SerialSettings settings{.path = directory / "tty", .flow = FlowControl::dtr_dsr};
  const auto pty = open_pty(settings.path);
  ASSERT_TRUE(pty) << pty.error().message;
  int lines = 0;
  Runner runner(loop.strand(),
                opener_on_thread([&] { return open_serial(settings).map([](int port) { return Descriptor(port); }); }),
                nullptr, [&](int) { return forbids(settings.flow, lines); });
  RecordingMachine machine(runner);
  runner.attach(machine);
  EXPECT_FALSE(runner.held()) << "it is not open";
  runner.start();
  ASSERT_TRUE(loop.run_until([&] { return machine.count("up") == 1; }));
  EXPECT_TRUE(runner.held());
  lines = TIOCM_DSR;
  EXPECT_FALSE(runner.held());
  lines = 0;
  bool ignored = false;
  runner.post([&](TimePoint) {
    runner.ignore_flow_control(true);
    ignored = !runner.held();
    runner.ignore_flow_control(false);
  });
  ASSERT_TRUE(loop.run_until([&] { return ignored; }));
  EXPECT_TRUE(runner.held());
  runner.shutdown();
  loop.run_ready();
}

}  // namespace
}  // namespace axisgate::link_flow_control_test
