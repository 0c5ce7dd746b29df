// The daemon's configuration: a TOML file, checked whole before anything is opened.
#pragma once

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
#include "device/link/serial_port.h"
#include "device/link/tcp_socket.h"
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

// The built-in simulator. With Profile::baud its bytes take the time that a real line takes.
struct SimulatedConnection {
  double speed = 1;    // its time runs so many times as fast
  bool paced = false;  // a baud rate was given: bytes take their time
  stage::Words options;
};

// The kinds that a configuration may name; they live as long as the program.
using DeviceKinds = std::span<const stage::Kind* const>;

struct DeviceConfig {
  const stage::Kind* kind = nullptr;  // one of DeviceKinds
  stage::Profile profile;
  stage::Words kind_settings;  // a word for each of kind->settings()
  std::variant<SimulatedConnection, SerialSettings, TcpSettings> connection;
  std::string record;  // the file that the daemon records the line to; empty: none
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

struct Config {
  TcpAddress listen;
  std::string socket;  // path of the Unix socket
  TcpAddress metrics;
  std::optional<NetworkConfig> network;
  AccessConfig access;
  LimitsConfig limits;
  JournalConfig journal;
  std::vector<DeviceConfig> devices;
};

// What the daemon runs without a file: one simulated device of the first kind, named `stage`.
Config default_config(DeviceKinds kinds);

// Every error in the file is reported, in the order of the lines; a syntax error ends the reading.
Configured<Config> load_config(const std::string& path, DeviceKinds kinds);

// The same of a text already read; `file` names it in errors.
Configured<Config> parse_config(std::string_view text, const std::string& file, DeviceKinds kinds);

}  // namespace axisgate::server
