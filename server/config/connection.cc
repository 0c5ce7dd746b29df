#include "server/config/connection.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <array>
#include <utility>

#include "device/core/explain.h"
#include "server/config/words.h"

namespace axisgate::server {
namespace {

constexpr std::array<std::pair<std::string_view, ConnectionKind>, 4> kConnections = {
    {{"serial", ConnectionKind::serial},
     {"tcp", ConnectionKind::tcp},
     {"simulated", ConnectionKind::simulated},
     {"printer", ConnectionKind::printer}}};

// USB has no rate: bytes arrive at once at a mill that takes hundredths of a second for a command.
constexpr int kPrinterBaud = 1'000'000;

// Only the name server can check a name, but a port or a blank in a name is a mistake.
bool is_host(std::string_view host) {
  in6_addr address{};
  const bool version_6 = ::inet_pton(AF_INET6, std::string(host).c_str(), &address) == 1;
  return version_6 || (!host.empty() && host.size() <= 253 && host.find_first_of(" \t:/[]") == std::string_view::npos);
}

}  // namespace

std::optional<ConnectionKind> ConnectionReader::read(ConfigTable& table, int usual_baud,
                                                     const CheckOption& check_option, DeviceConfig& device) {
  const auto kind = table.choice<ConnectionKind>("connection", kConnections);
  if (!kind && !table.has("connection"))
    table.missing("connection", "\"serial\", \"tcp\", \"simulated\" or \"printer\"");
  if (kind == ConnectionKind::printer) {
    device.baud = kPrinterBaud;
    device.connection = PrinterSettings{read_path(table, "the printer device", "/dev/usb/lp0")};
    return kind;
  }
  const std::optional<std::int64_t> baud = table.integer("baud", 300, 4'000'000);
  device.baud = static_cast<int>(baud.value_or(usual_baud));
  if (!kind) {
    // Without a known connection, all of these keys may be right, so none is reported as unknown.
    for (const char* key : {"path", "parity", "stop_bits", "flow_control", "host", "port", "speed", "options"}) {
      table.allow(key);
    }
  } else if (*kind == ConnectionKind::serial) {
    device.connection = read_serial(table, device.baud);
  } else if (*kind == ConnectionKind::tcp) {
    device.connection = read_tcp(table);
  } else {
    SimulatedConnection simulated = read_simulated(table, check_option);
    simulated.paced = baud.has_value();
    device.connection = std::move(simulated);
  }
  return kind;
}

std::string ConnectionReader::read_path(ConfigTable& table, std::string_view what, std::string_view example) {
  const std::optional<std::string> path = table.text("path");
  if (!path && !table.has("path")) table.missing("path", fmt::format("{}, e.g. \"{}\"", what, example));
  if (path && (path->empty() || path->front() != '/')) {
    table.error("path", fmt::format("\"{}\" is not an absolute path, e.g. \"{}\"", *path, example));
  } else if (path && !lines_.insert(*path).second) {
    table.error("path", fmt::format("\"{}\" is the line of another device, too; each has its own", *path));
  }
  return path.value_or("");
}

SerialSettings ConnectionReader::read_serial(ConfigTable& table, int baud) {
  SerialSettings serial;
  serial.path = read_path(table, "the tty, one of /dev/serial/by-id", "/dev/ttyUSB0");
  serial.parity = table.choice<Parity>("parity", kParities).value_or(serial.parity);
  serial.stop_bits = static_cast<int>(table.integer("stop_bits", 1, 2).value_or(serial.stop_bits));
  serial.flow = table.choice<FlowControl>("flow_control", kFlowControls).value_or(serial.flow);
  serial.baud = baud;
  return serial;
}

TcpSettings ConnectionReader::read_tcp(ConfigTable& table) {
  const std::optional<std::string> host = table.text("host");
  if (!host && !table.has("host")) {
    table.missing("host", "the serial server's name or address, e.g. \"192.168.0.20\"");
  }
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
  return tcp;
}

SimulatedConnection ConnectionReader::read_simulated(ConfigTable& table, const CheckOption& check_option) {
  SimulatedConnection simulated;
  simulated.speed =
      table.number("speed", 0.001, 10'000, "how many times as fast as real time, from 0.001 to 10000").value_or(1);
  const toml::table* options = table.table("options");
  if (options == nullptr) return simulated;
  ConfigTable chosen(*options, "device.options", file_, errors_);
  for (const auto& [key, node] : *options) {
    const std::optional<std::string> value = chosen.text(key.str());
    if (!value) continue;
    if (const Result<void> possible = check_option(key.str(), *value); !possible) {
      chosen.error(key.str(), explain(possible.error()));
    } else {
      simulated.options.emplace(key.str(), *value);
    }
  }
  return simulated;
}

}  // namespace axisgate::server
