// replay: feeds recordings to the core of this program's version. Needs no daemon.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "device/shrc203/recording/replay.h"
#include "device/stage/recording/recording.h"

namespace axisgate::axisctl {
namespace {

constexpr std::string_view kHead = "# axisgate recording ";
constexpr std::string_view kSection = "== ";  // begins a section of a support report

struct Part {
  int first_line = 1;  // line number in the file
  std::string text;
};

// Splits a file into its recordings. A daemon's file has a header for each start of the daemon and after each loss of
// lines; a support report has a header for each device.
std::vector<Part> recordings_in(std::istream& input) {
  std::vector<Part> parts;
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(input, line);) {
    ++number;
    if (line.starts_with(kHead)) {
      parts.push_back({number, ""});
      inside = true;
    }
    if (line.starts_with(kSection)) inside = false;
    if (inside) parts.back().text += line + "\n";
  }
  return parts;
}

std::vector<Part> read_parts(const std::string& file, const std::string& name) {
  std::ifstream opened;
  if (file != "-") {
    opened.open(file, std::ios::binary);
    if (!opened) throw usage(fmt::format("{} cannot be read: {}", file, std::strerror(errno)), "");
  }
  std::vector<Part> parts = recordings_in(file == "-" ? std::cin : opened);
  if (parts.empty()) {
    throw usage(fmt::format("{} is not a recording: no line begins with \"{}\"", name, kHead),
                "axisctl record makes one");
  }
  return parts;
}

shrc203::ReplayReport replay_part(const Part& part, const std::string& name) {
  const Result<stage::Recording> recording = stage::parse_recording(part.text);
  if (!recording) {
    const std::string from = part.first_line == 1 ? "" : fmt::format(" (counted from line {} on)", part.first_line);
    throw usage(fmt::format("{}{}: {}", name, from, recording.error().message), recording.error().hint);
  }
  return shrc203::replay(*recording);
}

int replay(const Session& session) {
  const std::string name = session.options.file == "-" ? "standard input" : session.options.file;
  std::uint64_t exchanges = 0;
  std::size_t differences = 0;
  for (const Part& part : read_parts(session.options.file, name)) {
    const shrc203::ReplayReport report = replay_part(part, name);
    for (const shrc203::ReplayDifference& difference : report.differences) {
      print_line(fmt::format("{}:{}: recorded {}; now {}", name, part.first_line - 1 + difference.line,
                             difference.recorded, difference.now));
    }
    exchanges += report.exchanges;
    differences += report.differences.size();
  }
  if (differences > 0) {
    print_line(fmt::format("{}: {} exchanges, {} {}", name, exchanges, differences,
                           differences == 1 ? "difference" : "differences"));
    return kFailed;
  }
  if (exchanges == 0) {
    throw Failure{kFailed, "NOTHING_COMPARED", fmt::format("{} has no exchange while the line is up", name),
                  "record while the controller answers"};
  }
  print_line(fmt::format("{}: {} exchanges, no difference", name, exchanges));
  return kDone;
}

void replay_options(CLI::App& verb, Options& options) {
  verb.add_option("FILE", options.file, "a recording or a support report; - reads the standard input")
      ->required()
      ->type_name("");
}

constexpr Verb kReplayVerbs[] = {
    {.words = "replay",
     .heading = Heading::raw,
     .description = "for developers: run recorded traffic through this version; moves nothing",
     .examples = "axisctl replay stage.recording",
     .add_options = replay_options,
     .run = replay,
     .has_json = false},
};

}  // namespace

std::span<const Verb> replay_verbs() { return kReplayVerbs; }

}  // namespace axisgate::axisctl
