// The daemon's configuration: a TOML file, checked completely before anything is opened.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "device/config/config_error.h"
#include "device/jobs/kind.h"
#include "device/link/printer_port.h"
#include "device/link/serial_port.h"
#include "device/link/tcp_socket.h"
#include "device/stage/kind.h"
#include "device/stage/profile.h"
#include "server/access/access.h"
#include "server/access/identity_limits.h"

namespace axisgate::server {

// HOST:PORT to listen on. Port 0 takes any free port, which is then in the log.
struct TcpAddress {
  std::string host;
  std::uint16_t port = 0;

  friend bool operator==(const TcpAddress&, const TcpAddress&) = default;
};
std::string to_string(const TcpAddress& address);  // "127.0.0.1:50203", "[::1]:50203"

// The built-in simulator. With a baud rate, bytes take as long as on a real line.
struct SimulatedConnection {
  double speed = 1;    // factor by which its time runs faster
  bool paced = false;  // a baud rate was given, so bytes take time
  Words options;
};

// The kinds that a configuration may name; they live as long as the program.
struct DeviceKinds {
  std::span<const stage::Kind* const> stages;  // the first is the default kind
  std::span<const jobs::Kind* const> mills{};  // may be empty
};

struct StageConfig {
  const stage::Kind* kind = nullptr;  // one of DeviceKinds::stages
  stage::Profile profile;             // its name and baud are unused; those of DeviceConfig count
  Words kind_settings;                // a word for each of kind->settings()
};

// Entry of MillConfig::station for every user of the Unix socket.
inline constexpr std::string_view kAnybodyOnUnix = "unix";

// A machine that is sent jobs.
struct MillConfig {
  enum class AtExit { abort, finish };

  const jobs::Kind* kind = nullptr;                               // one of DeviceKinds::mills
  std::string profile_name;                                       // Model::configured_name()
  std::shared_ptr<const jobs::Model> model;                       // never null in a configuration without errors
  jobs::SendSettings sending;                                     // with the device's baud
  std::vector<std::string> station{std::string(kAnybodyOnUnix)};  // callers who may confirm at the mill (Caller::who)
  std::chrono::minutes confirmation{10};                          // period for which a confirmation is valid
  std::vector<std::string> tools{"T1"};                           // at least one
  std::vector<jobs::NamedOrigin> origins;
  std::chrono::seconds busy_limit{600};  // time without a byte taken after which the mill is reported as still busy
  jobs::AtLoss at_loss = jobs::AtLoss::abort;  // action when the line is back after a loss during a job
  std::vector<std::string> doubts;  // possible mistakes that are no errors, for people who check the configuration
  bool holds_host_back = false;     // the line stops the host when the mill's buffer is full, so "full" loses nothing
  AtExit at_exit = AtExit::abort;   // action on a running job when the daemon ends
  double slower_percent = 0;        // of a simulated mill: additional time of each motion, in percent of the profile's
};

struct DeviceConfig {
  std::string name;
  int baud = stage::Profile{}.baud;
  std::variant<SimulatedConnection, SerialSettings, TcpSettings, PrinterSettings> connection;
  std::string record;           // file to which the daemon records the line; empty: none
  int record_megabytes = 1024;  // of that file and the previous one together
  std::variant<StageConfig, MillConfig> family;
};

// Endpoint for other machines: TLS 1.3, and every caller has a token or a certificate. The files are PEM, and are read
// again when they change.
struct NetworkConfig {
  TcpAddress listen;
  std::string certificate;  // of the daemon, with its chain, but without the authority that callers know
  std::string key;          // of that certificate
  std::string client_ca;    // authorities whose certificates name callers; empty: tokens only
};

// The journal of events and of the results of requests (journal/).
struct JournalConfig {
  bool kept = true;                  // false: request ids are remembered in memory only
  bool act_without = false;          // true: motions and changes are allowed even if the disk refuses the journal
  int days = 366, megabytes = 1024;  // of the history; older entries are removed
  int remember_hours = 24;           // for request ids; a shorter time if there are more than remember_requests
  int remember_requests = 20'000;
  Role others_seen_by = Role::observer;  // a caller with a lower role reads only their own entries
};

// Uploaded jobs of mills (spool/).
struct JobsConfig {
  int megabytes = 256;      // of all jobs
  int megabytes_each = 64;  // of one job
  int megabytes_per_person = 128;
  int count = 200;            // places of the queue, including jobs that have ended
  int count_per_person = 50;  // at most a quarter of count
  int days = 30;              // time for which a job is kept after its end
  int confirm_days = 14;      // time after which an unconfirmed job ends EXPIRED

  // Limit for one caller, and number of places reserved for callers who have no job in the queue.
  int quarter() const { return std::max(1, count / 4); }
};

struct Config {
  TcpAddress listen;
  std::string socket;  // path of the Unix socket
  TcpAddress metrics;
  std::optional<NetworkConfig> network;
  AccessConfig access;
  LimitsConfig limits;
  JournalConfig journal;
  JobsConfig jobs;
  std::vector<DeviceConfig> devices;
};

// Returns the configuration that is used without a file: one simulated stage of the first kind, named `stage`.
Config default_config(DeviceKinds kinds);

// Reports every error in the file, in the order of the lines. A syntax error ends the reading.
Configured<Config> load_config(const std::string& path, DeviceKinds kinds);

// Parses a text that has already been read; `file` is its name in errors.
Configured<Config> parse_config(std::string_view text, const std::string& file, DeviceKinds kinds);

}  // namespace axisgate::server
