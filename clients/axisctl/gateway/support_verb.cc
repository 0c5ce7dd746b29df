// support: writes a support report, one text file that can be read before it is sent, and mailed as it is.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/output.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "server/machine.h"

namespace axisgate::axisctl {
namespace {

// Deadline of the report: long enough for the recordings of several devices over a slow connection.
constexpr std::chrono::seconds kReportLimit{60};

constexpr std::string_view kUnixTarget = "unix:";

// Returns how the daemon is reached, without the address, which may identify people and machines.
std::string way_to(const std::string& target) {
  if (!target.starts_with(kUnixTarget)) return "by TCP";
  struct stat found = {};
  if (::stat(target.substr(kUnixTarget.size()).c_str(), &found) != 0) {
    return fmt::format("by a Unix socket, which cannot be reached: {}", std::strerror(errno));
  }
  return S_ISSOCK(found.st_mode) ? "by a Unix socket, which is there" : "by a path that is not a socket";
}

std::string head(const std::string& target) {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format(
      "== support report of Axisgate ==\n"
      "made {:%Y-%m-%d %H:%M:%S} UTC by axisctl " AXISGATE_VERSION
      "\n"
      "system {}\n"
      "the daemon is reached {}\n\n",
      fmt::gmtime(now), server::machine_text(), way_to(target));
}

std::string default_name() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("axisgate-support-{:%Y%m%d-%H%M%S}.txt", fmt::gmtime(now));
}

// Copies the daemon's report to the file. Throws Failure if the daemon does not send it whole.
void copy_report(const Session& session, Output& output) {
  grpc::ClientContext call;
  call.set_deadline(std::chrono::system_clock::now() + kReportLimit);
  const auto reader = session.connection.diagnostics->GetSupportReport(&call, v1::GetSupportReportRequest());
  v1::GetSupportReportResponse response;
  while (reader->Read(&response)) output.write(response.text());
  session.connection.check(reader->Finish());
}

int support(const Session& session) {
  const std::string& named = session.options.output;
  Output output(named.empty() ? default_name() : named);
  output.write(head(session.options.target.address));
  std::string_view lack;
  try {
    copy_report(session, output);
  } catch (const Failure& failure) {
    print_failure(failure);
    // The failure's message is left out, because it may contain the address.
    output.write(fmt::format("\n== no report of axisgated, or an incomplete one: {} ==\n", failure.reason));
    lack = "without the daemon's part; ";
  }
  if (output.is_file()) {
    print_line(fmt::format("{}: {}read it before you send it; its head shows what was replaced", output.path(), lack));
  }
  return kDone;
}

void support_options(CLI::App& verb, Options& options) {
  verb.add_option("--output", options.output,
                  "the file to write (default: axisgate-support-TIME.txt); - is the standard output")
      ->type_name("FILE");
}

constexpr Verb kSupportVerbs[] = {
    {.words = "support",
     .heading = Heading::raw,
     .description = "write a support report, without serial numbers and names of people",
     .examples = "axisctl support --output report.txt",
     .add_options = support_options,
     .run = support,
     .has_json = false},
};

}  // namespace

std::span<const Verb> support_verbs() { return kSupportVerbs; }

}  // namespace axisgate::axisctl
