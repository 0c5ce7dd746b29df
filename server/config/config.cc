#include "server/config/config.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "device/config/config_file.h"
#include "device/config/config_table.h"
#include "server/access/writers.h"
#include "server/config/access.h"
#include "server/config/axis.h"
#include "server/config/default_socket.h"
#include "server/config/journal.h"
#include "server/config/limits.h"
#include "server/config/name.h"
#include "server/config/network.h"
#include "server/config/words.h"
#include "server/explain.h"

namespace axisgate::server {
namespace {

using stage::AtExit;
using stage::AtLeaseEnd;
using stage::Profile;

constexpr std::uint16_t kGrpcPort = 50203;
constexpr std::uint16_t kMetricsPort = 9203;

enum class Connection { serial, tcp, simulated };
constexpr std::array<std::pair<std::string_view, Connection>, 3> kConnections = {
    {{"serial", Connection::serial}, {"tcp", Connection::tcp}, {"simulated", Connection::simulated}}};

// Names are for the name server to judge; a port or a blank in one is a slip.
bool is_host(std::string_view host) {
  in6_addr address{};
  const bool version_6 = ::inet_pton(AF_INET6, std::string(host).c_str(), &address) == 1;
  return version_6 || (!host.empty() && host.size() <= 253 && host.find_first_of(" \t:/[]") == std::string_view::npos);
}

class ConfigReader {
 public:
  ConfigReader(std::string file, std::vector<ConfigError>& errors, DeviceKinds kinds)
      : file_(std::move(file)), errors_(errors), kinds_(kinds) {}

  Config read(const toml::table& root) {
    ConfigTable table(root, "", file_, errors_);
    Config config = default_config(kinds_);
    config.devices.clear();
    read_loopback(table, "listen", "gRPC", config.listen);
    if (const auto socket = table.text("socket")) config.socket = checked_socket(table, *socket);
    read_loopback(table, "metrics", "metrics", config.metrics);
    config.network = read_network(table, file_, errors_);
    if (const toml::table* access = table.table("access")) read_access(*access, file_, errors_, config.access);
    if (const toml::table* limits = table.table("limits")) {
      read_identity_limits(*limits, file_, errors_, config.limits);
    }
    if (const toml::table* journal = table.table("journal")) read_journal(*journal, file_, errors_, config.journal);
    const auto devices = table.tables("device");
    if (devices.empty() && !table.has("device")) table.missing("device", "at least one [[device]]");
    for (const toml::table* device : devices) config.devices.push_back(read_device(*device));
    table.refuse_unknown();
    return config;
  }

 private:
  std::string checked_socket(ConfigTable& table, const std::string& path) {
    // sockaddr_un holds 108 bytes with the final zero.
    if (path.empty() || path.front() != '/' || path.size() > 107) {
      table.error("socket", fmt::format("\"{}\" will not do; use an absolute path of at most 107 bytes", path));
    }
    return path;
  }

  DeviceConfig read_device(const toml::table& source) {
    ConfigTable table(source, "device", file_, errors_);
    DeviceConfig device;
    read_name(table, device.profile.name);
    device.kind = read_kind(table);
    read_line(table, device);
    device.kind_settings = read_kind_settings(table, *device.kind);
    read_limits(table, device.profile);
    device.record = read_record(table);
    read_axes(table, file_, errors_, device.profile.axes);
    table.refuse_unknown();
    return device;
  }

  // Of a kind that there is not, the first stands in, so that the rest of the table is looked at all the same.
  const stage::Kind* read_kind(ConfigTable& table) {
    std::vector<std::pair<std::string_view, const stage::Kind*>> known;
    for (const stage::Kind* kind : kinds_) known.emplace_back(kind->name(), kind);
    return table.choice<const stage::Kind*>("kind", known).value_or(kinds_.front());
  }

  static stage::Words read_kind_settings(ConfigTable& table, const stage::Kind& kind) {
    stage::Words settings;
    for (const stage::KindSetting& setting : kind.settings()) {
      std::string& word = settings[std::string(setting.key)];
      word = setting.otherwise;
      if (setting.words.empty()) {
        if (const auto flag = table.flag(setting.key)) word = *flag ? "true" : "false";
        continue;
      }
      std::vector<std::pair<std::string_view, std::string_view>> words;
      for (const std::string_view one : setting.words) words.emplace_back(one, one);
      if (const auto chosen = table.choice<std::string_view>(setting.key, words)) word = *chosen;
    }
    return settings;
  }

  void read_name(ConfigTable& table, std::string& name) {
    const std::optional<std::string> given = table.text("name");
    if (!given) {
      if (!table.has("name")) table.missing("name", kNameRule);
      return;
    }
    if (!is_name(*given)) {
      table.error("name", fmt::format("\"{}\" is not a name; use {}", *given, kNameRule));
    } else if (!names_.insert(*given).second) {
      table.error("name", fmt::format("\"{}\" is the name of another device, too; names must differ", *given));
    }
    name = *given;
  }

  void read_line(ConfigTable& table, DeviceConfig& device) {
    const auto connection = table.choice<Connection>("connection", kConnections);
    if (!connection && !table.has("connection")) {
      table.missing("connection", "\"serial\", \"tcp\" or \"simulated\"");
    }
    const std::optional<std::int64_t> baud = table.integer("baud", 300, 4'000'000);
    if (baud) device.profile.baud = static_cast<int>(*baud);
    if (!connection) {
      // Without the connection it is not known which of these keys belong here: none is called unknown.
      for (const char* key :
           {"path", "parity", "stop_bits", "flow_control", "host", "port", "serial_number", "speed", "options"}) {
        table.allow(key);
      }
    } else if (*connection == Connection::serial) {
      device.connection = read_serial(table, device.profile);
    } else if (*connection == Connection::tcp) {
      device.connection = read_tcp(table, device.profile);
    } else {
      SimulatedConnection simulated = read_simulated(table, *device.kind);
      simulated.paced = baud.has_value();
      device.connection = std::move(simulated);
    }
  }

  SerialSettings read_serial(ConfigTable& table, Profile& profile) {
    SerialSettings serial;
    const std::optional<std::string> path = table.text("path");
    if (!path && !table.has("path"))
      table.missing("path", "the tty, e.g. \"/dev/ttyUSB0\" or one of /dev/serial/by-id");
    if (path && (path->empty() || path->front() != '/')) {
      table.error("path", fmt::format("\"{}\" is not an absolute path, e.g. \"/dev/ttyUSB0\"", *path));
    } else if (path && !lines_.insert(*path).second) {
      table.error("path", fmt::format("\"{}\" is the line of another device, too; each has its own", *path));
    }
    serial.path = path.value_or("");
    serial.parity = table.choice<Parity>("parity", kParities).value_or(serial.parity);
    serial.stop_bits = static_cast<int>(table.integer("stop_bits", 1, 2).value_or(serial.stop_bits));
    serial.flow = table.choice<FlowControl>("flow_control", kFlowControls).value_or(serial.flow);
    serial.baud = profile.baud;
    profile.serial_number = table.text("serial_number").value_or("");
    return serial;
  }

  TcpSettings read_tcp(ConfigTable& table, Profile& profile) {
    const std::optional<std::string> host = table.text("host");
    if (!host && !table.has("host"))
      table.missing("host", "the serial server's name or address, e.g. \"192.168.0.20\"");
    if (host && !is_host(*host)) {
      table.error("host", fmt::format("\"{}\" is neither a host name nor an address; the port has a key of its own, "
                                      "and an IPv6 address has no brackets",
                                      *host));
    }
    const std::optional<std::int64_t> port = table.integer("port", 1, 65535);
    if (!port && !table.has("port")) table.missing("port", "the port on which the serial server offers the raw line");
    TcpSettings tcp{host.value_or(""), static_cast<std::uint16_t>(port.value_or(0))};
    if (host && port && !lines_.insert(to_string(tcp)).second) {
      table.error("port", fmt::format("{} is the line of another device, too; each has its own", to_string(tcp)));
    }
    profile.serial_number = table.text("serial_number").value_or("");
    return tcp;
  }

  SimulatedConnection read_simulated(ConfigTable& table, const stage::Kind& kind) {
    SimulatedConnection simulated;
    simulated.speed =
        table.number("speed", 0.001, 10'000, "how many times as fast as real time, from 0.001 to 10000").value_or(1);
    const toml::table* options = table.table("options");
    if (options == nullptr) return simulated;
    ConfigTable chosen(*options, "device.options", file_, errors_);
    for (const auto& [key, node] : *options) {
      const std::optional<std::string> value = chosen.text(key.str());
      if (!value) continue;
      if (const Result<void> possible = kind.check_option(key.str(), *value); !possible) {
        chosen.error(key.str(), explain(possible.error()));
      } else {
        simulated.options.emplace(key.str(), *value);
      }
    }
    return simulated;
  }

  std::string read_record(ConfigTable& table) {
    const std::string path = table.text("record").value_or("");
    if (path.empty() && !table.has("record")) return path;
    if (path.empty() || path.front() != '/') {
      table.error("record", fmt::format("\"{}\" is not an absolute path, e.g. \"/var/tmp/stage.recording\"", path));
    } else if (!recordings_.insert(path).second) {
      table.error("record", fmt::format("\"{}\" is the file of another device, too; each has its own", path));
    }
    return path;
  }

  void read_limits(ConfigTable& table, Profile& profile) {
    profile.at_exit = table.choice<AtExit>("at_exit", kAtExit).value_or(profile.at_exit);
    profile.settings_at_lease_end =
        table.choice<AtLeaseEnd>("settings_at_lease_end", kAtLeaseEnd).value_or(profile.settings_at_lease_end);
    read_milliseconds(table, "reply_limit_ms", 50, 60'000, profile.reply_limit);
    read_milliseconds(table, "idle_poll_ms", 10, 60'000, profile.idle_poll);
    read_milliseconds(table, "moving_poll_ms", 10, 10'000, profile.moving_poll);
  }

  static void read_milliseconds(ConfigTable& table, std::string_view key, int minimum, int maximum, Duration& into) {
    if (const auto value = table.integer(key, minimum, maximum)) into = std::chrono::milliseconds(*value);
  }

  std::string file_;
  std::vector<ConfigError>& errors_;
  const DeviceKinds kinds_;
  std::set<std::string> names_;
  std::set<std::string> lines_;
  std::set<std::string> recordings_;
};

}  // namespace

Config default_config(DeviceKinds kinds) {
  DeviceConfig device;
  device.kind = kinds.front();
  for (const auto& setting : device.kind->settings()) device.kind_settings.emplace(setting.key, setting.otherwise);
  return Config{.listen = {"127.0.0.1", kGrpcPort},
                .socket = default_socket_to_listen(),
                .metrics = {"127.0.0.1", kMetricsPort},
                .network = {},
                .access = {.admin_commands = admin_commands(kinds)},
                .limits = {},
                .journal = {},
                .devices = {std::move(device)}};
}

Configured<Config> parse_config(std::string_view text, const std::string& file, DeviceKinds kinds) {
  std::vector<ConfigError> errors;
  Config config;
  try {
    const toml::table root = toml::parse(text, file);
    config = ConfigReader(file, errors, kinds).read(root);
  } catch (const toml::parse_error& error) {
    errors.push_back({file, error.source().begin.line, "", fmt::format("is not TOML: {}", error.description())});
  }
  if (errors.empty()) return config;
  // Those of the stage profiles that it names come last, each once whatever names it.
  const auto place = [&file](const ConfigError& error) {
    return std::tuple(error.file != file, std::string_view(error.file), error.line);
  };
  std::stable_sort(errors.begin(), errors.end(),
                   [&](const ConfigError& a, const ConfigError& b) { return place(a) < place(b); });
  const auto same = [](const ConfigError& a, const ConfigError& b) { return to_string(a) == to_string(b); };
  errors.erase(std::unique(errors.begin(), errors.end(), same), errors.end());
  return tl::unexpected(std::move(errors));
}

Configured<Config> load_config(const std::string& path, DeviceKinds kinds) {
  if (const Result<void> checked = check_writers(path); !checked) {
    return tl::unexpected(std::vector<ConfigError>{{path, 0, "", explain(checked.error())}});
  }
  const auto text = read_config_file(path);
  if (!text) return tl::unexpected(std::vector<ConfigError>{{path, 0, "", text.error()}});
  return parse_config(*text, path, kinds);
}

}  // namespace axisgate::server
