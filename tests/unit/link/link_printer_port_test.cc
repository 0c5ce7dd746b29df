// A printer device, simulated by a FIFO: opened only for writing, never read, closed without waiting.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "device/link/descriptor.h"
#include "device/link/printer_port.h"
#include "device/link/pty.h"
#include "device/link/runner.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::link_printer_port_test {
namespace {

using link_test::EventLoop;
using link_test::read_now;
using link_test::RecordingMachine;
using link_test::TemporaryDirectory;

// A FIFO replaces the device: it has no termios either, and takes bytes until it is full.
class PrinterPort : public testing::Test {
 protected:
  void plug_in() {
    ASSERT_EQ(::mkfifo(settings_.path.c_str(), 0600), 0);
    mill_ = Descriptor(::open(settings_.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    ASSERT_TRUE(mill_.valid());
  }

  void start() {
    runner_.attach(machine_);
    runner_.start();
    ASSERT_TRUE(loop_.run_until([&] { return machine_.count("up") == 1; }));
  }

  void write(std::string_view bytes) {
    runner_.post([this, bytes = std::string(bytes)](TimePoint) { runner_.write(bytes); });
  }

  bool comes(std::string_view expected) {
    std::string got;
    return loop_.run_until([&] { return (got += read_now(mill_.get())).ends_with(expected) && runner_.unsent() == 0; });
  }

  std::string refusal() {
    const auto opened = open_printer(settings_);
    if (!opened) return opened.error().message;
    Descriptor(*opened).reset();
    return "";
  }

  EventLoop loop_;
  TemporaryDirectory directory_;
  PrinterSettings settings_{directory_ / "lp0"};
  Descriptor mill_;
  Runner runner_{loop_.strand(), opener_on_thread([this] {
                   return open_printer(settings_).map([](int port) { return Descriptor(port); });
                 })};
  RecordingMachine machine_{runner_};
};

TEST_F(PrinterPort, WhatIsWrittenArrivesAndNothingIsRead) {
  plug_in();
  start();
  write("PU;");
  EXPECT_TRUE(comes("PU;"));
  EXPECT_EQ(machine_.heard, std::vector<std::string>{"up"});
}

TEST_F(PrinterPort, WhatTheDeviceDoesNotTakeIsUnsent) {
  plug_in();
  start();
  ASSERT_EQ(::fcntl(mill_.get(), F_SETPIPE_SZ, 4096), 4096);
  write(std::string(4096, ';'));
  ASSERT_TRUE(loop_.run_until([&] { return runner_.unsent() == 0; }));
  write("PU;");
  ASSERT_TRUE(loop_.run_until([&] { return runner_.unsent() == 3; }));
  EXPECT_FALSE(runner_.held()) << "it shows no flow control";
  runner_.post([this](TimePoint) { runner_.ignore_flow_control(true); });
  EXPECT_TRUE(comes("PU;"));
}

TEST_F(PrinterPort, ALossThatTheKernelReportsIsHeardWithoutAWrite) {
  plug_in();
  start();
  mill_.reset();
  EXPECT_TRUE(loop_.run_until([&] { return machine_.count("down") == 1; }));
}

// Closing does not wait for the remaining bytes.
TEST_F(PrinterPort, AFullLineIsClosedAtOnce) {
  plug_in();
  start();
  ASSERT_EQ(::fcntl(mill_.get(), F_SETPIPE_SZ, 4096), 4096);
  write(std::string(5000, ';'));
  ASSERT_TRUE(loop_.run_until([&] { return runner_.unsent() > 0; }));
  runner_.shutdown();
  loop_.run_ready();
  EXPECT_EQ(runner_.unsent(), 0u);
  EXPECT_EQ(machine_.count("down"), 0u);
}

TEST_F(PrinterPort, WhatIsNoPrinterIsRefused) {
  EXPECT_EQ(refusal(), "printer " + settings_.path + ": no such device");
  std::ofstream(settings_.path) << "a file";
  EXPECT_EQ(refusal(), "printer " + settings_.path + ": not a printer device");
  settings_.path = directory_ / "tty";
  const auto pty = open_pty(settings_.path);
  ASSERT_TRUE(pty) << pty.error().message;
  EXPECT_EQ(refusal(), "printer " + settings_.path + ": not a printer device");
}

}  // namespace
}  // namespace axisgate::link_printer_port_test
