#include "server/config_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "device/core/quantity.h"
#include "server/config_words.h"

namespace axisgate::server {
namespace {

std::string quoted(std::string_view text) {
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
  return quoted(found->first);
}

class TomlWriter {
 public:
  void table(std::string_view header) { text_ += fmt::format("\n{}\n", header); }
  void key(std::string_view name, std::string_view value) { text_ += fmt::format("{} = {}\n", name, value); }
  void text(std::string_view name, std::string_view value) { key(name, quoted(value)); }
  void number(std::string_view name, std::int64_t value) { key(name, fmt::to_string(value)); }
  void milliseconds(std::string_view name, Duration value) {
    number(name, std::chrono::duration_cast<std::chrono::milliseconds>(value).count());
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
  std::string commands, roles;
  for (const std::string& command : access.admin_commands) {
    commands += fmt::format("{}{}", commands.empty() ? "" : ", ", quoted(command));
  }
  for (const auto& [who, role] : access.roles) {
    roles += fmt::format("{}{} = {}", roles.empty() ? "" : ", ", quoted(who), word(kRoles, role));
  }
  out.key("admin_commands", fmt::format("[{}]", commands));
  if (!roles.empty()) out.key("roles", fmt::format("{{ {} }}", roles));
}

void write(TomlWriter& out, const LimitsConfig& limits) {
  out.table("[limits]");
  out.number("connections", limits.connections);
  out.number("streams", limits.streams);
  out.number("calls", limits.calls);
  out.number("message_bytes", limits.message_bytes);
}

void write(TomlWriter& out, const SerialSettings& serial, const shrc203::Profile& profile) {
  out.text("connection", "serial");
  out.text("path", serial.path);
  out.number("baud", profile.baud);
  out.key("parity", word(kParities, serial.parity));
  out.number("stop_bits", serial.stop_bits);
  out.key("flow_control", word(kFlowControls, serial.flow));
  if (!profile.serial_number.empty()) out.text("serial_number", profile.serial_number);
}

void write(TomlWriter& out, const TcpSettings& tcp, const shrc203::Profile& profile) {
  out.text("connection", "tcp");
  out.text("host", tcp.host);
  out.number("port", tcp.port);
  out.number("baud", profile.baud);
  if (!profile.serial_number.empty()) out.text("serial_number", profile.serial_number);
}

void write(TomlWriter& out, const SimulatedConnection& simulated, const shrc203::Profile& profile) {
  out.text("connection", "simulated");
  out.key("speed", fmt::to_string(simulated.speed));
  if (simulated.paced) out.number("baud", profile.baud);
  std::string options;
  for (const auto& [name, value] : simulated.options) {
    options += fmt::format("{}{} = {}", options.empty() ? "" : ", ", quoted(name), quoted(value));
  }
  if (!options.empty()) out.key("options", fmt::format("{{ {} }}", options));
}

void write_limits(TomlWriter& out, const shrc203::AxisLimits& limits) {
  out.quantity("travel_minimum", limits.travel_minimum);
  out.quantity("travel_maximum", limits.travel_maximum);
  out.quantity("maximum_speed", limits.maximum_speed, "/s");
  if (limits.home_first) out.key("home_first", "true");
}

void write(TomlWriter& out, const shrc203::StageProfile& stage) {
  const Unit unit = stage.pulse.rotary ? Unit::degrees : Unit::nanometers;
  out.table("[device.axis.stage]");
  out.text("name", stage.model);
  out.key("kind", word(kStageKinds, stage.pulse.rotary));
  out.quantity("pulse", Quantity{from_pulses(1, unit, stage.pulse).value_or(Decimal{}), unit});
  if (stage.modulo) out.quantity("modulo", Quantity{*stage.modulo, Unit::degrees});
}

void write(TomlWriter& out, int number, const shrc203::AxisProfile& axis) {
  out.table("[[device.axis]]");
  out.number("number", number);
  if (!axis.name.empty()) out.text("name", axis.name);
  out.text("unit", symbol(axis.unit));
  write_limits(out, axis);
  if (axis.stage) write(out, *axis.stage);
  for (const shrc203::NarrowerLimits& narrower : axis.narrower) {
    out.table("[[device.axis.narrower]]");
    out.text("whose", narrower.whose);
    write_limits(out, narrower);
  }
}

void write(TomlWriter& out, const DeviceConfig& device) {
  const shrc203::Profile& profile = device.profile;
  out.table("[[device]]");
  out.text("name", profile.name);
  std::visit([&](const auto& connection) { write(out, connection, profile); }, device.connection);
  out.key("busy_scope", word(kScopes, profile.busy_scope));
  out.key("prebuffer_scope", word(kScopes, profile.prebuffer_scope));
  out.key("at_exit", word(kAtExit, profile.at_exit));
  out.key("wait_for_inputs", profile.wait_for_inputs ? "true" : "false");
  out.key("settings_at_lease_end", word(kAtLeaseEnd, profile.settings_at_lease_end));
  out.milliseconds("reply_limit_ms", profile.reply_limit);
  out.milliseconds("idle_poll_ms", profile.idle_poll);
  out.milliseconds("moving_poll_ms", profile.moving_poll);
  if (!device.record.empty()) out.text("record", device.record);
  int number = 0;
  for (const shrc203::AxisProfile& axis : profile.axes) write(out, ++number, axis);
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
  for (const DeviceConfig& device : config.devices) write(out, device);
  return out.take();
}

}  // namespace axisgate::server
