#include "server/config/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "device/config/config_file.h"
#include "device/config/config_table.h"
#include "device/core/explain.h"
#include "server/access/writers.h"
#include "server/config/access.h"
#include "server/config/axis.h"
#include "server/config/connection.h"
#include "server/config/default_socket.h"
#include "server/config/jobs.h"
#include "server/config/journal.h"
#include "server/config/limits.h"
#include "server/config/mill.h"
#include "server/config/name.h"
#include "server/config/network.h"
#include "server/config/words.h"

namespace axisgate::server {
namespace {

using stage::AtExit;
using stage::AtLeaseEnd;
using stage::Profile;

constexpr std::uint16_t kMetricsPort = 9203;

class ConfigReader {
 public:
  ConfigReader(std::string file, std::vector<ConfigError>& errors, DeviceKinds kinds)
      : file_(std::move(file)), errors_(errors), kinds_(kinds), connections_(file_, errors) {}

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
    if (const toml::table* jobs = table.table("jobs")) read_jobs(*jobs, file_, errors_, config.jobs);
    if (const toml::table* journal = table.table("journal")) read_journal(*journal, file_, errors_, config.journal);
    const auto devices = table.tables("device");
    if (devices.empty() && !table.has("device")) table.missing("device", "at least one [[device]]");
    for (const toml::table* device : devices) config.devices.push_back(read_device(*device));
    table.refuse_unknown();
    return config;
  }

 private:
  std::string checked_socket(ConfigTable& table, const std::string& path) {
    // sockaddr_un has 108 bytes, including the final zero.
    if (path.empty() || path.front() != '/' || path.size() > 107) {
      table.error("socket", fmt::format("\"{}\" will not do; use an absolute path of at most 107 bytes", path));
    }
    return path;
  }

  DeviceConfig read_device(const toml::table& source) {
    ConfigTable table(source, "device", file_, errors_);
    DeviceConfig device;
    read_name(table, device.name);
    const AnyKind kind = read_kind(table);
    if (const auto* mill = std::get_if<const jobs::Kind*>(&kind)) {
      device.family = read_mill(table, **mill, file_, errors_, connections_, device);
    } else {
      device.family = read_stage_config(table, *std::get<const stage::Kind*>(kind), device);
    }
    device.record = read_record(table);
    constexpr int kLeast = 32;  // each of the two files begins with the 4 MiB that are kept in memory
    if (const auto given = table.integer("record_megabytes", kLeast, 1'000'000)) {
      device.record_megabytes = static_cast<int>(*given);
    }
    table.refuse_unknown();
    return device;
  }

  using AnyKind = std::variant<const stage::Kind*, const jobs::Kind*>;

  // Returns the first kind in place of an unknown one, so that the rest of the table is checked as well.
  AnyKind read_kind(ConfigTable& table) {
    std::vector<std::pair<std::string_view, AnyKind>> known;
    for (const stage::Kind* kind : kinds_.stages) known.emplace_back(kind->name(), kind);
    for (const jobs::Kind* kind : kinds_.mills) known.emplace_back(kind->name(), kind);
    return table.choice<AnyKind>("kind", known).value_or(kinds_.stages.front());
  }

  // Also sets `device`'s connection.
  StageConfig read_stage_config(ConfigTable& table, const stage::Kind& kind, DeviceConfig& device) {
    StageConfig stage{.kind = &kind, .profile = {}, .kind_settings = {}};
    const auto check = [&kind](std::string_view name, std::string_view value) {
      return kind.check_option(name, value);
    };
    const auto connection = connections_.read(table, stage.profile.baud, check, device);
    if (connection == ConnectionKind::printer) {
      table.error("connection", "\"printer\" is for mills: a printer device never answers; use \"serial\"");
    }
    const auto* serial = std::get_if<SerialSettings>(&device.connection);
    if (serial != nullptr && serial->flow == FlowControl::dtr_dsr) {
      table.error("flow_control",
                  "\"dtr_dsr\" is for mills: no driver does it, and a command to a stage does not wait "
                  "for it; use \"rtscts\"");
    }
    if (connection != ConnectionKind::simulated) stage.profile.serial_number = table.text("serial_number").value_or("");
    stage.kind_settings = read_kind_settings(table, kind);
    read_limits(table, stage.profile);
    read_axes(table, file_, errors_, kind.axis_count(), stage.profile.axes);
    return stage;
  }

  static Words read_kind_settings(ConfigTable& table, const stage::Kind& kind) {
    Words settings;
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

  std::string read_record(ConfigTable& table) {
    const std::string path = table.text("record").value_or("");
    if (path.empty() && !table.has("record")) return path;
    if (path.empty() || path.front() != '/') {
      table.error("record", fmt::format("\"{}\" is not an absolute path, e.g. \"/var/tmp/stage.recording\"", path));
    } else if (!recordings_.insert(path).second || !recordings_.insert(path + ".1").second) {
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
  ConnectionReader connections_;
  std::set<std::string> names_;
  std::set<std::string> recordings_;
};

}  // namespace

Config default_config(DeviceKinds kinds) {
  StageConfig stage{.kind = kinds.stages.front(), .profile = {}, .kind_settings = {}};
  for (const auto& setting : stage.kind->settings()) stage.kind_settings.emplace(setting.key, setting.otherwise);
  DeviceConfig device{.name = stage.profile.name, .connection = {}, .record = {}, .family = std::move(stage)};
  return Config{.listen = {"127.0.0.1", kGrpcPort},
                .socket = default_socket_to_listen(),
                .metrics = {"127.0.0.1", kMetricsPort},
                .network = {},
                .access = {.admin_commands = admin_commands(kinds)},
                .limits = {},
                .journal = {},
                .jobs = {},
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
  // Errors in the profiles that the file names come last. A profile's error is listed once, even if several tables name
  // the profile.
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
