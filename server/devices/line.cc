#include "server/devices/line.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "device/core/paced_line.h"
#include "device/link/low_latency.h"
#include "device/link/printer_port.h"
#include "device/link/serial_port.h"
#include "device/link/socket_pair.h"
#include "device/link/tcp_socket.h"
#include "server/log.h"

namespace axisgate::server {
namespace {

// An OutsideLine leads to a device outside of this process.
class OutsideLine final : public Line {
 public:
  OutsideLine(Opener opener, std::string description, HeldReader held = {})
      : opener_(std::move(opener)), description_(std::move(description)), held_(std::move(held)) {}

  Opener opener() override { return opener_; }
  HeldReader held_reader() const override { return held_; }
  const std::string& description() const override { return description_; }
  void start() override {}
  void shutdown() override {}

 private:
  const Opener opener_;
  const std::string description_;
  const HeldReader held_;
};

OpenedLine open(const SerialSettings& settings) {
  const Result<int> port = open_serial(settings);
  if (!port) return tl::unexpected(port.error());
  if (const auto warning = ask_for_low_latency(*port, settings.path)) log::warn("{}", *warning);
  return Descriptor(*port);
}

// Opens the port on its own thread, because an adapter that hangs may block its driver for seconds.
std::unique_ptr<Line> make_serial(const SerialSettings& settings) {
  return std::make_unique<OutsideLine>(opener_on_thread([settings] { return open(settings); }),
                                       fmt::format("{} at {} baud", settings.path, settings.baud),
                                       [flow = settings.flow](int port) { return is_held(port, flow); });
}

std::unique_ptr<Line> make_printer(const PrinterSettings& settings) {
  const auto open_it = [settings] { return open_printer(settings).map([](int port) { return Descriptor(port); }); };
  return std::make_unique<OutsideLine>(opener_on_thread(open_it), settings.path);
}

std::unique_ptr<Line> make_tcp(const TcpSettings& settings, int baud) {
  return std::make_unique<OutsideLine>(tcp_opener(settings),
                                       fmt::format("tcp {} at {} baud", to_string(settings), baud));
}

std::unique_ptr<Simulation> simulate(const StageConfig& stage, const Words& options, ByteLink& line) {
  return stage.kind->make_simulation(options, line);
}

std::unique_ptr<Simulation> simulate(const MillConfig& mill, const Words& options, ByteLink& line) {
  return mill.model->make_simulation(options, mill.sending.buffer, mill.slower_percent, line);
}

class SimulatedLine final : public Line {
 public:
  // `simulate` is called once, in the constructor.
  SimulatedLine(Pacing pacing, const std::function<std::unique_ptr<Simulation>(ByteLink&)>& simulate, Strand strand,
                std::string description)
      : description_(std::move(description)),
        runner_(std::move(strand)),
        device_(pacing, runner_, [this, &simulate](ByteLink& inside) {
          auto simulation = simulate(inside);
          simulation_ = simulation.get();
          return simulation;
        }) {
    runner_.attach(device_);
  }

  Opener opener() override { return line_to(runner_); }
  const std::string& description() const override { return description_; }
  void start() override { runner_.start(); }
  void shutdown() override { runner_.shutdown(); }

  void operate(std::string command, OnOperated done) override {
    runner_.post([this, command = std::move(command), done = std::move(done)](TimePoint now) {
      device_.touch(now, [&](TimePoint device_now) { done(simulation_->operate(command, device_now)); });
    });
  }

 private:
  const std::string description_;
  Runner runner_;
  Simulation* simulation_ = nullptr;  // owned by device_
  PacedLine device_;
};

std::unique_ptr<Line> make_simulated(const SimulatedConnection& connection, const DeviceConfig& config, Strand strand) {
  const Pacing pacing{connection.paced ? config.baud : 0, Duration{}, connection.speed};
  const auto of_family = [&](ByteLink& line) {
    return std::visit([&](const auto& family) { return simulate(family, connection.options, line); }, config.family);
  };
  return std::make_unique<SimulatedLine>(pacing, of_family, std::move(strand),
                                         fmt::format("built-in simulator, speed {}", connection.speed));
}

}  // namespace

void Line::operate(std::string, OnOperated done) {
  done(fail(Reason::invalid_request, "the device is not simulated", "do it at the device itself"));
}

std::unique_ptr<Line> make_line(const DeviceConfig& config, Strand strand) {
  if (const auto* serial = std::get_if<SerialSettings>(&config.connection)) {
    return make_serial(*serial);
  }
  if (const auto* printer = std::get_if<PrinterSettings>(&config.connection)) return make_printer(*printer);
  if (const auto* tcp = std::get_if<TcpSettings>(&config.connection)) return make_tcp(*tcp, config.baud);
  return make_simulated(std::get<SimulatedConnection>(config.connection), config, std::move(strand));
}

}  // namespace axisgate::server
