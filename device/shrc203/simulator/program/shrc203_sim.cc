// shrc203-sim: the simulated SHRC-203 on a pseudo-terminal, for a gateway or any other program to open.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/link/pty_line.h"
#include "device/link/simulator_program.h"
#include "device/shrc203/simulator/options.h"
#include "device/shrc203/simulator/simulator.h"

namespace axisgate {
namespace {

namespace simulator = shrc203::simulator;

constexpr std::string_view kProgram = "shrc203-sim";

struct Arguments {
  std::string pty;
  std::string control;
  double speed = 1;
  int baud = 0;
  int reply_delay_ms = 0;
  std::string serial_number = simulator::Options().serial_number;
  std::vector<std::string> options;
  bool list_options = false;
};

void describe(CLI::App& program, Arguments& arguments) {
  auto* pty = program.add_option("--pty", arguments.pty, "Symbolic link to make to the simulator's terminal");
  program.add_option("--speed", arguments.speed, "The simulator's time runs this many times as fast")
      ->check(CLI::Range(0.001, 10000.0))
      ->capture_default_str();
  program.add_option("--baud", arguments.baud, "Pace of the bytes both ways, ten bits a byte; 0 passes them at once")
      ->check(CLI::Range(0, 4'000'000))
      ->capture_default_str();
  program.add_option("--reply-delay", arguments.reply_delay_ms, "Milliseconds from a command's end to its reply")
      ->check(CLI::Range(0, 60'000))
      ->capture_default_str();
  program.add_option("--serial-number", arguments.serial_number, "What *IDN? and ?:SN say: another unit")
      ->capture_default_str();
  program.add_option("--control", arguments.control,
                     "Unix socket to make, for what a person at the device does; `help` on it lists the commands");
  program.add_option("--option", arguments.options, "NAME=VALUE: a reading of the manual; may be repeated")
      ->allow_extra_args(false);
  program.add_flag("--list-options", arguments.list_options, "Print every option and its values, and end")
      ->excludes(pty);
}

Result<simulator::Options> choose_options(const Arguments& arguments) {
  simulator::Options options;
  options.serial_number = arguments.serial_number;
  const auto set = set_options(arguments.options, [&](auto name, auto value) { return options.set(name, value); });
  if (!set) return tl::unexpected(set.error());
  return options;
}

Result<std::shared_ptr<PtyLine>> open_line(const Strand& strand, const std::string& link) {
  auto pty = open_pty(link);
  if (!pty) return tl::unexpected(pty.error());
  auto watch = PtyWatch::open(*pty);
  if (!watch) return tl::unexpected(watch.error());
  return std::make_shared<PtyLine>(strand, std::move(*pty), std::move(*watch));
}

int run(const Arguments& arguments, const simulator::Options& options) {
  boost::asio::io_context context(1);
  // Before the link exists, so that a program that sees the link can already end this one cleanly.
  boost::asio::signal_set signals(context, SIGINT, SIGTERM, SIGHUP);
  // Before the link is created, which may replace the link of a program that still runs.
  auto control = open_control(arguments.control);
  if (!control) return complain(kProgram, kSimulatorFailed, control.error());
  auto opened = open_line(boost::asio::make_strand(context), arguments.pty);
  if (!opened) return complain(kProgram, kSimulatorFailed, opened.error());
  const PtyLine& line = **opened;

  const Pacing pacing{arguments.baud, std::chrono::milliseconds(arguments.reply_delay_ms), arguments.speed};
  SimulatedDevice<PtyLine> device(
      pacing, *opened, [&](ByteLink& inside) { return std::make_unique<simulator::Simulator>(options, inside); });
  (*opened)->start();
  if (*control) device.take_commands((*control)->take_socket());
  signals.async_wait([&](const boost::system::error_code&, int) { device.shutdown(); });

  const std::string pace = arguments.baud == 0 ? "bytes not paced" : fmt::format("{} baud", arguments.baud);
  const std::string where = arguments.control.empty() ? "" : fmt::format(", control socket {}", arguments.control);
  fmt::print("SHRC-203 simulator on {} ({}), {}, speed {}, reply delay {} ms{}\n", arguments.pty, line.pty().device(),
             pace, arguments.speed, arguments.reply_delay_ms, where);
  std::fflush(stdout);
  context.run();
  return 0;
}

int main_program(int count, char** words) {
  CLI::App program("A simulated SIGMAKOKI SHRC-203 stage controller on a pseudo terminal.", "shrc203-sim");
  Arguments arguments;
  describe(program, arguments);
  try {
    program.parse(count, words);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);
    return complain_of_usage(kProgram, error.what());
  }
  if (arguments.list_options) {
    print_options(simulator::option_names());
    return 0;
  }
  if (arguments.pty.empty()) {
    return complain_of_usage(kProgram, "--pty LINK is required");
  }
  const auto options = choose_options(arguments);
  if (!options) return complain(kProgram, kSimulatorUsage, options.error());
  return run(arguments, *options);
}

}  // namespace
}  // namespace axisgate

int main(int count, char** words) { return axisgate::main_program(count, words); }
