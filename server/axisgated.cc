// axisgated: owns the lines of the configured stage controllers and shares them over gRPC.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/core/explain.h"
#include "device/link/clock.h"
#include "server/access/access.h"
#include "server/access/generation.h"
#include "server/access/state_directory.h"
#include "server/config/config.h"
#include "server/connections/callers.h"
#include "server/connections/certificate_watch.h"
#include "server/connections/descriptor_limit.h"
#include "server/devices/motion_record.h"
#include "server/devices/saved_positions.h"
#include "server/doors/doors.h"
#include "server/end_signals.h"
#include "server/gateway.h"
#include "server/journal/journal.h"
#include "server/kinds.h"
#include "server/log.h"
#include "server/metrics/certificate_metrics.h"
#include "server/metrics/journal_metrics.h"
#include "server/service_manager.h"
#include "server/spare_memory.h"
#include "server/spool/spool.h"
#include "server/watchdog.h"

namespace axisgate {
namespace {

constexpr int kExitFailed = 1;
constexpr int kExitUsage = 2;  // the command line or the configuration is wrong

struct Arguments {
  std::string config;
  bool check_config = false;
};

void describe(CLI::App& program, Arguments& arguments) {
  program.add_option("--config", arguments.config,
                     "TOML file with the devices; without it one simulated SHRC-203 named `stage` is served");
  program.add_flag("--check-config", arguments.check_config, "Check the configuration, say what is wrong, and end");
  program.set_version_flag("--version", "axisgated " AXISGATE_VERSION);
  program.footer(
      "Ctrl-C, SIGTERM and most other signals end the daemon in order: motions first stop or finish, as `at_exit`\n"
      "says. A second signal ends it at once, and what moves may continue to move. Ctrl-Z is ignored.\n\n"
      "Exit codes: 0 ended by a signal, or all is well; 1 it could not start; 2 the command line or the\n"
      "configuration is wrong.");
}

int complain(int exit_code, const std::string& what) {
  fmt::print(stderr, "axisgated: {}\n", what);
  return exit_code;
}

int complain(const std::vector<ConfigError>& errors) {
  for (const ConfigError& error : errors) fmt::print(stderr, "{}\n", to_string(error));
  return kExitUsage;
}

Result<std::uint32_t> start_generation(const server::StateDirectory& state) {
  const auto now = static_cast<std::uint32_t>(std::time(nullptr));
  const Result<server::NewGeneration> generation = server::next_generation(state.path(), now);
  if (!generation) return tl::unexpected(generation.error());
  if (!generation->kept) {
    server::log::warn("{}; only the clock distinguishes lease tokens from those of earlier runs",
                      explain(generation->kept.error()));
  }
  return generation->number;
}

Result<std::unique_ptr<server::Access>> open_access(const server::AccessConfig& config,
                                                    const server::StateDirectory& state) {
  auto tokens = server::Tokens::open(state.file("tokens"));
  if (!tokens) return tl::unexpected(tokens.error());
  return std::make_unique<server::Access>(config, server::caller_name(::geteuid()), *std::move(tokens));
}

// Returns null if no service manager waits for signs of life.
std::unique_ptr<server::Watchdog> watch(server::Gateway& gateway, server::Doors& doors) {
  const std::optional<Duration> time = server::watchdog_time();
  if (!time) return nullptr;
  std::vector<server::Watchdog::Thread> threads = doors.threads();
  for (server::Stage* stage : gateway.stages()) {
    threads.push_back(
        {fmt::format("the thread of the lines, at {},", stage->name()), [stage](std::function<void()> answer) {
           stage->post([answer = std::move(answer)](stage::StageController&, TimePoint) { answer(); });
         }});
  }
  // The watchdog itself runs on the readers' thread, so this thread needs no question. Four pings per interval allow
  // for a late one.
  constexpr int kPings = 4;
  return std::make_unique<server::Watchdog>(
      std::move(threads), *time / kPings,
      [&gateway](Duration wait, std::function<void()> task) { gateway.timeouts().after(wait, std::move(task)); },
      server::notify_alive);
}

server::journal::Entry entry_of_daemon(server::journal::EntryKind kind) {
  return {.kind = kind,
          .time = std::chrono::system_clock::now(),
          .boot_time = monotonic_now(),
          .body = R"({"version":")" AXISGATE_VERSION R"("})"};
}

server::spool::Bounds bounds_of(const server::JobsConfig& jobs) {
  const auto bytes = [](int megabytes) { return megabytes * server::spool::kMebibyte; };
  return {.bytes = bytes(jobs.megabytes),
          .bytes_of_one = bytes(jobs.megabytes_each),
          .bytes_of_identity = bytes(jobs.megabytes_per_person),
          .jobs = static_cast<std::size_t>(jobs.count),
          .jobs_of_identity = static_cast<std::size_t>(jobs.count_per_person),
          .jobs_reserved = static_cast<std::size_t>(jobs.quarter()),
          .kept = std::chrono::days(jobs.days)};
}

// Never returns null: if the file cannot be opened, the daemon refuses or allows motions as on a disk that refuses.
std::unique_ptr<server::journal::Journal> open_journal(const server::StateDirectory& state,
                                                       const server::JournalConfig& config) {
  const server::journal::StoreBounds bounds{std::chrono::hours(24 * config.days), std::int64_t{config.megabytes} << 20};
  const std::string path = state.file("journal.sqlite");
  auto opened = server::journal::Journal::open(path, server::boot_id(), bounds);
  if (opened) return *std::move(opened);
  server::log::error("the journal could not be opened, so motions and changes are {}: {}; then restart the daemon",
                     config.act_without ? "not recorded" : "refused", explain(opened.error()));
  return server::journal::Journal::unopened(path, opened.error());
}

void log_what_is_served(const server::Gateway& gateway, const server::Doors& doors, int metrics_port) {
  const server::Config& config = gateway.config();
  const server::TcpAddress metrics{config.metrics.host, static_cast<std::uint16_t>(metrics_port)};
  server::log::info("gRPC on {} and unix:{}", to_string(doors.listen()), doors.socket());
  if (config.network) server::log::info("gRPC with TLS on {}", to_string(*doors.network()));
  server::log::info("metrics on http://{}/metrics", to_string(metrics));
  for (const auto& device : gateway.devices()) {
    server::log::info("device {}: {} on {}", device->name(), device->kind_name(), device->line_description());
  }
  server::log::flush();
}

// Objects that are opened before the gateway and outlive it.
struct Kept {
  std::unique_ptr<server::Access> access;
  std::unique_ptr<server::SavedPositions> positions;
  std::unique_ptr<server::spool::Spool> spool;
  std::unique_ptr<server::journal::Journal> journal;  // null with `kept = false`
};

// Serves until a signal ends the daemon.
int serve(server::Gateway& gateway, const Kept& kept, server::EndSignals& end_signals) {
  const server::Config& config = gateway.config();
  const Result<int> metrics_port = gateway.metrics().expose(config.metrics);
  if (!metrics_port) return complain(kExitFailed, explain(metrics_port.error()));
  const server::ConnectionLimits limits{.open = server::raise_descriptor_limit(),
                                        .of_one = static_cast<std::size_t>(config.limits.connections)};
  const auto doors = server::Doors::open(gateway, *kept.access, *kept.positions, limits);
  if (!doors) return complain(kExitFailed, explain(doors.error()));
  if (config.network) {
    gateway.metrics().add(std::make_shared<server::CertificateMetrics>(config.network->certificate));
    server::watch_certificate(config.network->certificate, gateway.timeouts());
  }
  if (config.journal.kept) gateway.metrics().add(std::make_shared<server::JournalMetrics>(*kept.journal));
  log_what_is_served(gateway, **doors, *metrics_port);
  gateway.start();
  server::keep_little_spare_memory(gateway.timeouts());
  const auto watchdog = watch(gateway, **doors);
  server::notify_ready();
  end_signals.wait(gateway);
  return 0;
}

int serve(const server::Config& config) {
  using server::journal::EntryKind;
  server::EndSignals end_signals;
  server::log::start();
  // The directory is locked until all its writers have ended.
  const auto state = server::StateDirectory::hold(server::default_state_directory());
  if (!state) return complain(kExitFailed, explain(state.error()));
  auto access = open_access(config.access, *state);
  if (!access) return complain(kExitFailed, explain(access.error()));
  auto positions = server::SavedPositions::open(state->file("positions"));
  if (!positions) return complain(kExitFailed, explain(positions.error()));
  const auto generation = start_generation(*state);
  if (!generation) return complain(kExitFailed, explain(generation.error()));
  auto spool = server::spool::Spool::open(state->file("spool"), bounds_of(config.jobs));
  if (!spool) return complain(kExitFailed, explain(spool.error()));
  const Kept kept{*std::move(access), *std::move(positions), *std::move(spool),
                  config.journal.kept ? open_journal(*state, config.journal) : nullptr};
  server::journal::Journal* const journal = kept.journal.get();
  int exit_code = 0;
  {
    server::Gateway gateway(config, *generation, state->path(), journal, kept.spool.get());
    if (journal != nullptr) journal->append({entry_of_daemon(EntryKind::daemon_started)});
    exit_code = serve(gateway, kept, end_signals);
  }
  // No event is published after this, so if this entry is on the disk, all events are.
  if (journal != nullptr) journal->append({entry_of_daemon(EntryKind::daemon_ended)});
  return exit_code;
}

void print_doubts(const server::Config& config) {
  for (const server::DeviceConfig& device : config.devices) {
    const auto* mill = std::get_if<server::MillConfig>(&device.family);
    if (mill == nullptr) continue;
    for (const std::string& doubt : mill->doubts) fmt::print("{}: {}\n", device.name, doubt);
  }
}

int main_program(int count, char** words) {
  CLI::App program("Owns the serial lines of SHRC-203 stage controllers and shares them over gRPC.", "axisgated");
  Arguments arguments;
  describe(program, arguments);
  try {
    program.parse(count, words);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);
    return complain(kExitUsage, fmt::format("{}; see --help", error.what()));
  }
  const bool from_file = !arguments.config.empty();
  const Configured<server::Config> config = from_file ? server::load_config(arguments.config, server::device_kinds())
                                                      : server::default_config(server::device_kinds());
  if (!config) return complain(config.error());
  if (!arguments.check_config) return serve(*config);
  const std::size_t devices = config->devices.size();
  fmt::print("{}: ok, {} {}\n", from_file ? arguments.config : "built-in configuration", devices,
             devices == 1 ? "device" : "devices");
  print_doubts(*config);
  return 0;
}

}  // namespace
}  // namespace axisgate

int main(int count, char** words) {
  try {
    return axisgate::main_program(count, words);
  } catch (const std::exception& error) {
    return axisgate::complain(axisgate::kExitFailed, error.what());
  }
}
