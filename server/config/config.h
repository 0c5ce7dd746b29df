// The daemon's configuration: a TOML file, checked whole before anything is opened.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "device/config/config_error.h"
#include "device/link/printer_port.h"
#include "device/link/serial_port.h"
#include "device/link/tcp_socket.h"
#include "device/rml1/machine/known_machine.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/sending/sender.h"
#include "device/stage/kind.h"
#include "device/stage/profile.h"
#include "server/access/access.h"
#include "server/access/identity_limits.h"

namespace axisgate::server {

// HOST:PORT to listen on. Port 0 takes any free one; the log says which.
struct TcpAddress {
  std::string host;
  std::uint16_t port = 0;

  friend bool operator==(const TcpAddress&, const TcpAddress&) = default;
};
std::string to_string(const TcpAddress& address);  // "127.0.0.1:50203", "[::1]:50203"

// The built-in simulator. With a baud rate its bytes take the time that a real line takes.
struct SimulatedConnection {
  double speed = 1;    // its time runs so many times as fast
  bool paced = false;  // a baud rate was given: bytes take their time
  stage::Words options;
};

// The kinds that a configuration may name; they live as long as the program.
struct DeviceKinds {
  std::span<const stage::Kind* const> stages;  // the first is that of a device whose table names none
  std::string_view mill = {};                  // the name of mills that read RML-1; empty: there are none
};

struct StageConfig {
  const stage::Kind* kind = nullptr;  // one of DeviceKinds::stages
  stage::Profile profile;             // of its name and baud those of the DeviceConfig count
  stage::Words kind_settings;         // a word for each of kind->settings()
};

// A place of the work origin.
struct NamedOrigin {
  std::string name;
  std::int64_t x = 0, y = 0;        // the mill's steps from its home corner, within its work area
  std::optional<std::int64_t> z{};  // of Z0: a machine coordinate, in steps; none: as it is set at the mill
};

// As an entry of MillConfig::station: every user of the Unix socket.
inline constexpr std::string_view kAnybodyOnUnix = "unix";

// A mill that reads RML-1 (device/rml1).
struct MillConfig {
  enum class AtExit { abort, finish };

  std::string_view kind;     // DeviceKinds::mill
  std::string profile_name;  // as the configuration has it: "mdx-20", or the absolute path of a file
  rml1::Profile profile;
  std::string profile_text;                                       // the content of its file
  std::vector<rml1::KnownMachine> others;                         // what a job may have been made for instead
  rml1::SendSettings sending;                                     // with the device's baud
  std::vector<std::string> station{std::string(kAnybodyOnUnix)};  // who may confirm at the mill, as in Caller::who
  std::chrono::minutes confirmation{10};                          // how long a confirmation is valid
  std::vector<std::string> tools{"T1"};                           // at least one
  std::vector<NamedOrigin> origins;
  std::chrono::seconds busy_limit{600};        // after so long without a byte taken it is reported as still busy
  rml1::AtLoss at_loss = rml1::AtLoss::abort;  // what is sent when the line is back, where a job ran when it broke
  std::vector<std::string> doubts;  // what may be wrong without being an error, for people who check the configuration
  bool holds_host_back = false;     // the line, while the mill's buffer is full: "full" streaming loses nothing
  AtExit at_exit = AtExit::abort;   // what happens to a running job when the daemon ends
  double slower_percent = 0;        // of a simulated mill: each motion takes so much longer than by the profile
};

struct DeviceConfig {
  std::string name;
  int baud = stage::Profile{}.baud;
  std::variant<SimulatedConnection, SerialSettings, TcpSettings, PrinterSettings> connection;
  std::string record;           // the file that the daemon records the line to; empty: none
  int record_megabytes = 1024;  // of that file and the one before it, together
  std::variant<StageConfig, MillConfig> family;
};

// Where other machines call: TLS 1.3, and every caller has a token or a certificate. The files are PEM. They are read
// again when they change.
struct NetworkConfig {
  TcpAddress listen;
  std::string certificate;  // of the daemon, with the chain up to, not with, the authority that callers know
  std::string key;          // of that certificate
  std::string client_ca;    // authorities whose certificates name callers; empty: tokens only
};

// What has happened, and what requests have become (journal/).
struct JournalConfig {
  bool kept = true;                  // false: request ids are remembered in memory only
  bool act_without = false;          // what moves and changes is done also where the disk refuses the journal
  int days = 366, megabytes = 1024;  // of the history; what is older is dropped
  int remember_hours = 24;           // request ids; less long, where there are more than:
  int remember_requests = 20'000;
  Role others_seen_by = Role::observer;  // who has a lower role reads only their own entries
};

// Uploaded jobs of mills (spool/).
struct JobsConfig {
  int megabytes = 256;      // of all jobs
  int megabytes_each = 64;  // of one
  int megabytes_per_person = 128;
  int count = 200;            // the places of the queue, with those of jobs that have ended
  int count_per_person = 50;  // a quarter of them or less
  int days = 30;              // that a job is kept after its end
  int confirm_days = 14;      // a job that nobody confirms by then ends EXPIRED

  // The most for one caller, and what is left at the end for those who have no job in the queue.
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

// What the daemon runs without a file: one simulated stage of the first kind, named `stage`.
Config default_config(DeviceKinds kinds);

// Every error in the file is reported, in the order of the lines; a syntax error ends the reading.
Configured<Config> load_config(const std::string& path, DeviceKinds kinds);

// The same of a text already read; `file` names it in errors.
Configured<Config> parse_config(std::string_view text, const std::string& file, DeviceKinds kinds);

}  // namespace axisgate::server
