#include "server/config/mill.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "server/config/caller.h"
#include "server/config/name.h"
#include "server/config/words.h"

namespace axisgate::server {
namespace {

constexpr std::string_view kStationRule =
    "\"unix\", everybody on this machine's Unix socket, or a caller, \"unix LOGIN\", \"cert NAME\" or \"token NAME\"";

constexpr std::string_view kSlackRule = "a number from 1 to 10, or \"measured\"";

// A number of steps has at most 24 bits (guideline 2-3).
constexpr std::int64_t kStepsMax = 8'388'607;
constexpr jobs::OriginLimits kAnySteps{kStepsMax, kStepsMax, -kStepsMax, kStepsMax};

void read_bytes(ConfigTable& table, std::string_view key, std::int64_t minimum, std::int64_t maximum,
                std::size_t& into) {
  if (const auto bytes = table.integer(key, minimum, maximum)) into = static_cast<std::size_t>(*bytes);
}

void read_slack(ConfigTable& table, jobs::SendSettings& sending) {
  if (!table.holds_text("slack")) {
    sending.slack = table.number("slack", 1, 10, kSlackRule).value_or(sending.slack);
    return;
  }
  const std::string word = table.text("slack").value_or("");
  sending.slack_as_measured = word == kMeasured;
  if (!sending.slack_as_measured) table.error("slack", fmt::format("\"{}\" is not known; use {}", word, kSlackRule));
}

// Paced streaming takes longer than the mill needs, but loses no bytes. It is the default unless the configuration
// states that the line stops the host. DSR is not enough: the present command is still sent to its end.
jobs::Streaming usual_streaming(const ConfigTable& table, const DeviceConfig& device) {
  const auto* serial = std::get_if<SerialSettings>(&device.connection);
  const bool said = table.has("flow_control") && serial != nullptr &&
                    (serial->flow == FlowControl::rts_cts || serial->flow == FlowControl::xon_xoff);
  const bool full = (said || std::holds_alternative<PrinterSettings>(device.connection)) && !table.has("window");
  return full ? jobs::Streaming::full : jobs::Streaming::paced;
}

void read_sending(ConfigTable& table, const DeviceConfig& device, jobs::SendSettings& sending) {
  const auto streaming = table.choice<jobs::Streaming>("streaming", kStreamings);
  sending.streaming = streaming.value_or(usual_streaming(table, device));
  read_bytes(table, "window", 16, 4096, sending.window);
  read_bytes(table, "buffer", 16, 1 << 20, sending.buffer);
  read_bytes(table, "converter", 0, 65'536, sending.converter);
  read_slack(table, sending);
  if (sending.window > sending.buffer) {
    table.error("window", fmt::format("{} bytes do not fit the mill's buffer of {} bytes; use a window that does",
                                      sending.window, sending.buffer));
  }
}

void read_station(ConfigTable& table, std::vector<std::string>& station) {
  const auto callers = table.texts("station");
  if (!callers) return;
  if (callers->empty()) {
    table.error("station", fmt::format("is empty, so nobody could confirm at the mill; use {}", kStationRule));
  }
  for (const std::string& caller : *callers) {
    if (caller == kAnybodyOnUnix) continue;
    const std::string wrong = wrong_with_caller(caller, "is not a caller as the daemon names them");
    if (!wrong.empty()) table.error("station", fmt::format("\"{}\" {}; use {}", caller, wrong, kStationRule));
  }
  station = *callers;
}

void read_tools(ConfigTable& table, std::vector<std::string>& tools) {
  const auto names = table.texts("tools");
  if (!names) return;
  if (names->empty()) table.error("tools", "is empty; use at least one name, [\"T1\"]");
  std::set<std::string> known;
  for (const std::string& name : *names) {
    if (!is_name(name)) {
      table.error("tools", fmt::format("\"{}\" is not a name; use {}", name, kNameRule));
    } else if (!known.insert(name).second) {
      table.error("tools", fmt::format("\"{}\" is the name of another tool, too; names must differ", name));
    }
  }
  tools = *names;
}

std::string read_origin_name(ConfigTable& table, std::set<std::string>& known) {
  const std::optional<std::string> name = table.text("name");
  if (!name && !table.has("name")) table.missing("name", kNameRule);
  if (!name) return {};
  if (!is_name(*name)) {
    table.error("name", fmt::format("\"{}\" is not a name; use {}", *name, kNameRule));
  } else if (!known.insert(*name).second) {
    table.error("name", fmt::format("\"{}\" is the name of another origin of this device, too", *name));
  }
  return *name;
}

std::int64_t read_steps(ConfigTable& table, std::string_view key, std::int64_t most) {
  const std::optional<std::int64_t> steps = table.integer(key, 0, most);
  if (!steps && !table.has(key)) {
    table.missing(key, fmt::format("the mill's steps from its home corner, a whole number from 0 to {}", most));
  }
  return steps.value_or(0);
}

std::vector<jobs::NamedOrigin> read_origins(ConfigTable& device, const jobs::OriginLimits& limits,
                                            std::string_view file, std::vector<ConfigError>& errors) {
  std::set<std::string> names;
  std::vector<jobs::NamedOrigin> origins;
  for (const toml::table* source : device.tables("origin")) {
    ConfigTable table(*source, "device.origin", file, errors);
    std::string name = read_origin_name(table, names);
    const std::int64_t x = read_steps(table, "x", limits.x_most), y = read_steps(table, "y", limits.y_most);
    origins.push_back({std::move(name), x, y, table.integer("z", limits.z_least, limits.z_most)});
    table.refuse_unknown();
  }
  return origins;
}

// Paced streaming sends no more than fits the buffer by computation. With full streaming, only the line can stop the
// host.
bool holds_host_back(const DeviceConfig& device) {
  const auto* serial = std::get_if<SerialSettings>(&device.connection);
  if (serial != nullptr) return serial->flow != FlowControl::none;
  return !std::holds_alternative<SimulatedConnection>(device.connection);
}

void refuse_full(ConfigTable& table, const DeviceConfig& device) {
  constexpr std::string_view kWhy =
      "\"full\" sends as fast as the line takes it, and {}, so bytes would be lost when the mill's buffer is full; use "
      "{}";
  const bool simulated = std::holds_alternative<SimulatedConnection>(device.connection);
  table.error("streaming",
              simulated ? fmt::format(fmt::runtime(kWhy), "nothing holds the host back from the built-in simulator",
                                      "\"paced\", or rml1-sim on a port")
                        : fmt::format(fmt::runtime(kWhy), "with flow_control = \"none\" nothing holds the host back",
                                      "\"paced\", or flow_control = \"rtscts\""));
}

// The daemon does not see the line of a serial server, and the built-in simulator never stops the host.
bool has_flow_control(const DeviceConfig& device) {
  const auto* serial = std::get_if<SerialSettings>(&device.connection);
  if (serial != nullptr) return serial->flow != FlowControl::none;
  return std::holds_alternative<PrinterSettings>(device.connection);
}

// Warns about baud rate and flow control, since a mill never answers: a mistake would only show in a spoilt workpiece.
std::vector<std::string> doubts_about(const ConfigTable& table, const DeviceConfig& device, const MillConfig& mill) {
  std::vector<std::string> doubts;
  const auto* serial = std::get_if<SerialSettings>(&device.connection);
  if (serial == nullptr) return doubts;
  if (!table.has("baud") && !mill.model->baud()) {
    doubts.push_back(
        fmt::format("no baud rate is given, and {} baud are assumed: the {} is usually connected by USB "
                    "(connection = \"printer\"); for a serial line set `baud` as at the mill",
                    device.baud, mill.model->name()));
  }
  if (!table.has("flow_control")) {
    doubts.emplace_back("`flow_control` is not given: RTS/CTS is assumed, and jobs are paced; set it as at the mill");
  } else if (serial->flow == FlowControl::none) {
    doubts.emplace_back("no flow control: a full buffer of the mill loses bytes, and jobs are paced");
  }
  return doubts;
}

}  // namespace

MillConfig read_mill(ConfigTable& table, const jobs::Kind& kind, std::string_view file,
                     std::vector<ConfigError>& errors, ConnectionReader& connections, DeviceConfig& device) {
  MillConfig mill;
  mill.kind = &kind;
  mill.model = kind.read_model(table, errors);
  if (mill.model) mill.profile_name = mill.model->configured_name();
  const auto check = [&kind](std::string_view option, std::string_view value) {
    return kind.check_option(option, value);
  };
  const std::optional<int> usual_baud = mill.model ? mill.model->baud() : std::nullopt;
  const auto connection = connections.read(table, usual_baud.value_or(mill.sending.baud), check, device);
  if (!connection || *connection == ConnectionKind::simulated) {
    mill.slower_percent = table.number("slower", 0, 1000, "percent from 0 to 1000").value_or(mill.slower_percent);
  }
  mill.sending.flow_control = has_flow_control(device);
  read_sending(table, device, mill.sending);
  mill.sending.baud = device.baud;
  mill.holds_host_back = holds_host_back(device);
  if (connection && mill.sending.streaming == jobs::Streaming::full && !mill.holds_host_back)
    refuse_full(table, device);
  read_station(table, mill.station);
  if (const auto minutes = table.integer("confirmation_minutes", 1, 1440)) {
    mill.confirmation = std::chrono::minutes(*minutes);
  }
  read_tools(table, mill.tools);
  if (const auto limit = table.integer("busy_limit_s", 10, 86'400)) mill.busy_limit = std::chrono::seconds(*limit);
  mill.at_loss = table.choice<jobs::AtLoss>("at_loss", kMillAtLoss).value_or(mill.at_loss);
  mill.at_exit = table.choice<MillConfig::AtExit>("at_exit", kMillAtExit).value_or(mill.at_exit);
  mill.origins = read_origins(table, mill.model ? mill.model->origin_limits() : kAnySteps, file, errors);
  if (mill.model) mill.doubts = doubts_about(table, device, mill);
  return mill;
}

}  // namespace axisgate::server
