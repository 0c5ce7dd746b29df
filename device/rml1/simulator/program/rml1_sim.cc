// The program rml1-sim: a simulated mill on a pseudo-terminal or a TCP port, which a sender of jobs can open.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "device/link/simulator_program.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/machine/profile_files.h"
#include "device/rml1/simulator/options.h"
#include "device/rml1/simulator/program/host_end.h"
#include "device/rml1/simulator/program/mill_line.h"
#include "device/rml1/simulator/simulator.h"

namespace axisgate::rml1::simulator {
namespace {

constexpr std::string_view kProgram = "rml1-sim";

struct Arguments {
  std::string pty;
  std::optional<int> tcp;
  std::string profile;
  std::size_t buffer = MillSetup{}.buffer_bytes;
  std::string flow = "none";
  std::optional<int> baud;
  double slower = 0;
  double speed = 1;
  std::string record;
  std::string control;
  std::vector<std::string> options;
  bool list_options = false;
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using RecordFile = std::unique_ptr<std::FILE, CloseFile>;

void describe_line(CLI::App& program, Arguments& arguments) {
  auto* pty = program.add_option("--pty", arguments.pty, "Symbolic link to make to the mill's terminal");
  program.add_option("--tcp", arguments.tcp, "Port on 127.0.0.1, as of a serial server; 0 is any free one")
      ->check(CLI::Range(0, 65535))
      ->excludes(pty);
  program.add_option("--buffer", arguments.buffer, "Bytes that the mill holds")
      ->check(CLI::Range(16, 1 << 20))
      ->capture_default_str();
  program.add_option("--flow", arguments.flow, "How the mill holds its host back")
      ->check(CLI::IsMember(std::vector<std::string>{"none", "xon", "rts"}))
      ->capture_default_str();
  program
      .add_option("--baud", arguments.baud,
                  "Rate of the line, ten bits a byte; 0 passes bytes at once; without it the profile's")
      ->check(CLI::Range(0, 4'000'000));
}

void describe(CLI::App& program, Arguments& arguments) {
  describe_line(program, arguments);
  program.add_option("--profile", arguments.profile, "The machine: a profile's name, as mdx-20, or its file");
  program.add_option("--slower", arguments.slower, "Percent by which each motion takes longer than by the profile")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  program.add_option("--speed", arguments.speed, "The time of the mill and its line runs this many times as fast")
      ->check(CLI::Range(0.001, 10000.0))
      ->capture_default_str();
  program.add_option("--record", arguments.record, "File for what the mill does, as lines of JSON");
  program.add_option("--control", arguments.control,
                     "Unix socket to make, for what a person at the mill does; `help` on it lists the commands");
  program.add_option("--option", arguments.options, "NAME=VALUE: an interpretation of the guideline; may be repeated")
      ->allow_extra_args(false);
  program.add_flag("--list-options", arguments.list_options, "Print every option and its values, and end");
}

Result<Options> choose_options(const Arguments& arguments) {
  Options options;
  const auto set = set_options(arguments.options, [&](auto name, auto value) { return options.set(name, value); });
  if (!set) return tl::unexpected(set.error());
  return options;
}

Result<Profile> choose_profile(const std::string& name) {
  if (name.empty()) return fail(Reason::invalid_request, "--profile P is required", "See --help.");
  const auto file = profile_file(name);
  if (!file) return fail(Reason::invalid_request, file.error().message + "; " + file.error().hint);
  auto profile = load_profile(file->string());
  if (profile) return std::move(*profile);
  std::string errors;
  for (const ConfigError& error : profile.error()) errors += (errors.empty() ? "" : "; ") + to_string(error);
  return fail(Reason::invalid_request, errors, "Correct the profile.");
}

Flow flow_called(const std::string& name) {
  if (name == "xon") return Flow::xon;
  return name == "rts" ? Flow::rts : Flow::none;
}

Result<MillSetup> choose_setup(const Arguments& arguments) {
  auto options = choose_options(arguments);
  if (!options) return tl::unexpected(options.error());
  auto profile = choose_profile(arguments.profile);
  if (!profile) return tl::unexpected(profile.error());
  return MillSetup{std::move(*profile), std::move(*options), arguments.buffer, flow_called(arguments.flow),
                   arguments.slower};
}

Result<RecordFile> open_record(const std::string& path) {
  if (path.empty()) return RecordFile();
  RecordFile file(std::fopen(path.c_str(), "we"));
  if (file) return file;
  return fail(Reason::invalid_request, fmt::format("--record {}: {}", path, std::generic_category().message(errno)),
              "Choose another file.");
}

Result<std::unique_ptr<HostEnd>> open_end(const Strand& strand, const Arguments& arguments) {
  return arguments.tcp ? open_tcp_end(strand, *arguments.tcp) : open_pty_end(strand, arguments.pty);
}

Record::Write writer(std::FILE* record) {
  if (record == nullptr) return {};
  return [record](std::string_view line) {
    fmt::print(record, "{}\n", line);
    std::fflush(record);
  };
}

Duration byte_time(int baud, double speed) {
  if (baud == 0) return Duration::zero();
  return Duration(static_cast<std::int64_t>(10e9 / baud / speed));
}

int run(const Arguments& arguments, const MillSetup& setup) {
  boost::asio::io_context context(1);
  // Catches signals before the link exists, so that anybody who sees the link can end this program cleanly.
  boost::asio::signal_set signals(context, SIGINT, SIGTERM, SIGHUP);
  const auto record = open_record(arguments.record);
  if (!record) return complain(kProgram, kSimulatorFailed, record.error());
  // Opens the socket before the link is made: the link may belong to a program that still runs.
  auto control = open_control(arguments.control);
  if (!control) return complain(kProgram, kSimulatorFailed, control.error());
  const Strand strand = boost::asio::make_strand(context);
  auto end = open_end(strand, arguments);
  if (!end) return complain(kProgram, kSimulatorFailed, end.error());

  const int baud = arguments.baud.value_or(setup.profile.baud.value_or(0));
  // The handshake keeps a quarter of the buffer free for bytes that come after the host was stopped.
  const std::size_t at_once = setup.flow == Flow::none ? MillLine::kBytesMax : setup.buffer_bytes / 4;
  const auto line = std::make_shared<MillLine>(strand, std::move(*end), byte_time(baud, arguments.speed), at_once);
  const Simulator* simulator = nullptr;  // owned by `mill`
  SimulatedDevice<MillLine> mill({.speed = arguments.speed}, line, [&](ByteLink& inside) {
    auto made = std::make_unique<Simulator>(setup, inside, writer(record->get()));
    simulator = made.get();
    return made;
  });
  // A pseudo-terminal has no CTS, so with rts reading stops instead.
  line->start([&, obeys = setup.flow == Flow::rts] {
    return simulator->holds_back() && (obeys || line->end().stops_at_xoff());
  });
  if (*control) mill.take_commands((*control)->take_socket());
  signals.async_wait([&](const boost::system::error_code&, int) { mill.shutdown(); });

  const std::string pace = baud == 0 ? "bytes not paced" : fmt::format("{} baud", baud);
  const std::string where = arguments.control.empty() ? "" : fmt::format(", control socket {}", arguments.control);
  fmt::print("{} simulator on {}, {}, speed {}, buffer {} bytes{}\n", setup.profile.name, line->end().name(), pace,
             arguments.speed, arguments.buffer, where);
  std::fflush(stdout);
  context.run();
  return 0;
}

int main_program(int count, char** words) {
  CLI::App program("A simulated Roland mill that reads RML-1, on a pseudo-terminal or a TCP port.", "rml1-sim");
  Arguments arguments;
  describe(program, arguments);
  try {
    program.parse(count, words);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);
    return complain_of_usage(kProgram, error.what());
  }
  if (arguments.list_options) {
    print_options(option_names());
    return 0;
  }
  if (arguments.pty.empty() && !arguments.tcp)
    return complain_of_usage(kProgram, "--pty LINK or --tcp PORT is required");
  const auto setup = choose_setup(arguments);
  if (!setup) return complain(kProgram, kSimulatorUsage, setup.error());
  return run(arguments, *setup);
}

}  // namespace
}  // namespace axisgate::rml1::simulator

int main(int count, char** words) { return axisgate::rml1::simulator::main_program(count, words); }
