#include "server/config/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "device/core/quantity.h"
#include "server/config/words.h"

namespace axisgate::server {
namespace {

std::string in_quotes(std::string_view text) {
  std::string toml = "\"";
  for (const char byte : text) {
    if (byte == '"' || byte == '\\') {
      toml += fmt::format("\\{}", byte);
    } else if (static_cast<unsigned char>(byte) < 0x20 || byte == 0x7f) {
      toml += fmt::format("\\u{:04x}", static_cast<unsigned>(byte));
    } else {
      toml += byte;
    }
  }
  return toml + "\"";
}

template <class Words, class Value>
std::string word(const Words& words, Value value) {
  const auto found = std::find_if(words.begin(), words.end(), [&](const auto& pair) { return pair.second == value; });
  return in_quotes(found->first);
}

class TomlWriter {
 public:
  void table(std::string_view header) { text_ += fmt::format("\n{}\n", header); }
  void key(std::string_view name, std::string_view value) { text_ += fmt::format("{} = {}\n", name, value); }
  void text(std::string_view name, std::string_view value) { key(name, in_quotes(value)); }
  void number(std::string_view name, std::int64_t value) { key(name, fmt::to_string(value)); }
  void milliseconds(std::string_view name, Duration value) {
    number(name, std::chrono::duration_cast<std::chrono::milliseconds>(value).count());
  }
  void texts(std::string_view name, const std::vector<std::string>& values) {
    std::string list;
    for (const std::string& value : values) list += fmt::format("{}{}", list.empty() ? "" : ", ", in_quotes(value));
    key(name, fmt::format("[{}]", list));
  }
  void quantity(std::string_view name, const std::optional<Quantity>& value, std::string_view per = "") {
    if (value) text(name, fmt::format("{}{}{}", to_string(value->value), symbol(value->unit), per));
  }

  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void write(TomlWriter& out, const NetworkConfig& network) {
  out.table("[network]");
  out.text("listen", to_string(network.listen));
  out.text("certificate", network.certificate);
  out.text("key", network.key);
  if (!network.client_ca.empty()) out.text("client_ca", network.client_ca);
}

void write(TomlWriter& out, const AccessConfig& access) {
  out.table("[access]");
  out.key("local", word(kRoles, access.local));
  out.key("certificates", word(kRoles, access.certificates));
  std::vector<std::string> commands;
  for (const AdminCommand& command : access.admin_commands) commands.push_back(command.name);
  std::string roles;
  for (const auto& [who, role] : access.roles) {
    roles += fmt::format("{}{} = {}", roles.empty() ? "" : ", ", in_quotes(who), word(kRoles, role));
  }
  out.texts("admin_commands", commands);
  if (!roles.empty()) out.key("roles", fmt::format("{{ {} }}", roles));
}

void write(TomlWriter& out, const LimitsConfig& limits) {
  out.table("[limits]");
  out.number("connections", limits.connections);
  out.number("streams", limits.streams);
  out.number("calls", limits.calls);
  out.number("message_bytes", limits.message_bytes);
}

void write(TomlWriter& out, const JournalConfig& journal) {
  out.table("[journal]");
  out.key("kept", journal.kept ? "true" : "false");
  out.key("unavailable", word(kUnavailable, journal.act_without));
  out.number("days", journal.days);
  out.number("megabytes", journal.megabytes);
  out.number("remember_hours", journal.remember_hours);
  out.number("remember_requests", journal.remember_requests);
  out.key("others_seen_by", word(kRoles, journal.others_seen_by));
}

void write(TomlWriter& out, const JobsConfig& jobs) {
  out.table("[jobs]");
  out.number("megabytes", jobs.megabytes);
  out.number("megabytes_each", jobs.megabytes_each);
  out.number("megabytes_per_person", jobs.megabytes_per_person);
  out.number("count", jobs.count);
  out.number("count_per_person", jobs.count_per_person);
  out.number("days", jobs.days);
  out.number("confirm_days", jobs.confirm_days);
}

void write(TomlWriter& out, const SerialSettings& serial, int baud) {
  out.text("connection", "serial");
  out.text("path", serial.path);
  out.number("baud", baud);
  out.key("parity", word(kParities, serial.parity));
  out.number("stop_bits", serial.stop_bits);
  out.key("flow_control", word(kFlowControls, serial.flow));
}

void write(TomlWriter& out, const TcpSettings& tcp, int baud) {
  out.text("connection", "tcp");
  out.text("host", tcp.host);
  out.number("port", tcp.port);
  out.number("baud", baud);
}

void write(TomlWriter& out, const PrinterSettings& printer, int) {
  out.text("connection", "printer");
  out.text("path", printer.path);
}

void write(TomlWriter& out, const SimulatedConnection& simulated, int baud) {
  out.text("connection", "simulated");
  out.key("speed", fmt::to_string(simulated.speed));
  if (simulated.paced) out.number("baud", baud);
  std::string options;
  for (const auto& [name, value] : simulated.options) {
    options += fmt::format("{}{} = {}", options.empty() ? "" : ", ", in_quotes(name), in_quotes(value));
  }
  if (!options.empty()) out.key("options", fmt::format("{{ {} }}", options));
}

void write_limits(TomlWriter& out, const stage::AxisLimits& limits) {
  out.quantity("travel_minimum", limits.travel_minimum);
  out.quantity("travel_maximum", limits.travel_maximum);
  out.quantity("maximum_speed", limits.maximum_speed, "/s");
  if (limits.require_homing) out.key("require_homing", "true");
}

void write(TomlWriter& out, const stage::StageProfile& stage) {
  const Unit unit = stage.pulse.rotary ? Unit::degrees : Unit::nanometers;
  out.table("[device.axis.stage]");
  out.text("name", stage.model);
  out.key("kind", word(kStageKinds, stage.pulse.rotary));
  out.quantity("pulse", Quantity{from_pulses(1, unit, stage.pulse).value_or(Decimal{}), unit});
  if (stage.modulo) out.quantity("modulo", Quantity{*stage.modulo, Unit::degrees});
}

void write(TomlWriter& out, int number, const stage::AxisProfile& axis) {
  out.table("[[device.axis]]");
  out.number("number", number);
  if (!axis.name.empty()) out.text("name", axis.name);
  out.text("unit", symbol(axis.unit));
  write_limits(out, axis);
  if (axis.stage) write(out, *axis.stage);
  for (const stage::LimitOverride& theirs : axis.overrides) {
    out.table("[[device.axis.override]]");
    out.text("whose", theirs.whose);
    write_limits(out, theirs);
  }
}

void write(TomlWriter& out, const stage::Kind& kind, const Words& settings) {
  for (const stage::KindSetting& setting : kind.settings()) {
    const std::string& word = settings.at(std::string(setting.key));
    out.key(setting.key, setting.words.empty() ? word : in_quotes(word));
  }
}

std::string_view kind_of(const StageConfig& stage) { return stage.kind == nullptr ? "" : stage.kind->name(); }
std::string_view kind_of(const MillConfig& mill) { return mill.kind->name(); }

void write(TomlWriter& out, const StageConfig& stage, const DeviceConfig&) {
  const stage::Profile& profile = stage.profile;
  if (!profile.serial_number.empty()) out.text("serial_number", profile.serial_number);
  if (stage.kind != nullptr) write(out, *stage.kind, stage.kind_settings);
  out.key("at_exit", word(kAtExit, profile.at_exit));
  out.key("settings_at_lease_end", word(kAtLeaseEnd, profile.settings_at_lease_end));
  out.milliseconds("reply_limit_ms", profile.reply_limit);
  out.milliseconds("idle_poll_ms", profile.idle_poll);
  out.milliseconds("moving_poll_ms", profile.moving_poll);
  const int count = stage.kind == nullptr ? 0 : stage.kind->axis_count();
  for (int number = 1; number <= count; ++number) write(out, number, profile.axis(number));
}

void write(TomlWriter& out, const MillConfig& mill, const DeviceConfig& device) {
  if (std::holds_alternative<SimulatedConnection>(device.connection)) {
    out.key("slower", fmt::to_string(mill.slower_percent));
  }
  out.text("profile", mill.profile_name);
  out.key("streaming", word(kStreamings, mill.sending.streaming));
  if (mill.sending.window != 0) out.key("window", fmt::to_string(mill.sending.window));
  out.key("buffer", fmt::to_string(mill.sending.buffer));
  out.key("converter", fmt::to_string(mill.sending.converter));
  out.key("slack", mill.sending.slack_as_measured ? in_quotes(kMeasured) : fmt::to_string(mill.sending.slack));
  out.texts("station", mill.station);
  out.number("confirmation_minutes", mill.confirmation.count());
  out.texts("tools", mill.tools);
  out.number("busy_limit_s", mill.busy_limit.count());
  out.key("at_loss", word(kMillAtLoss, mill.at_loss));
  out.key("at_exit", word(kMillAtExit, mill.at_exit));
  for (const jobs::NamedOrigin& origin : mill.origins) {
    out.table("[[device.origin]]");
    out.text("name", origin.name);
    out.number("x", origin.x);
    out.number("y", origin.y);
    if (origin.z) out.number("z", *origin.z);
  }
}

void write(TomlWriter& out, const DeviceConfig& device) {
  out.table("[[device]]");
  out.text("name", device.name);
  const auto kind = std::visit([](const auto& family) { return kind_of(family); }, device.family);
  if (!kind.empty()) out.text("kind", kind);
  std::visit([&](const auto& connection) { write(out, connection, device.baud); }, device.connection);
  if (!device.record.empty()) out.text("record", device.record);
  if (!device.record.empty()) out.number("record_megabytes", device.record_megabytes);
  std::visit([&](const auto& family) { write(out, family, device); }, device.family);
}

}  // namespace

std::string to_toml(const Config& config) {
  TomlWriter out;
  out.text("listen", to_string(config.listen));
  out.text("socket", config.socket);
  out.text("metrics", to_string(config.metrics));
  if (config.network) write(out, *config.network);
  write(out, config.access);
  write(out, config.limits);
  write(out, config.journal);
  write(out, config.jobs);
  for (const DeviceConfig& device : config.devices) write(out, device);
  return out.take();
}

}  // namespace axisgate::server
