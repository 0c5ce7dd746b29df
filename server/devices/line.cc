#include "server/devices/line.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>
#include <variant>

#include "device/core/paced_line.h"
#include "device/link/low_latency.h"
#include "device/link/serial_port.h"
#include "device/link/socket_pair.h"
#include "device/link/tcp_socket.h"

namespace axisgate::server {
namespace {

// A device outside of this process.
class OutsideLine final : public Line {
 public:
  OutsideLine(Opener opener, std::string description)
      : opener_(std::move(opener)), description_(std::move(description)) {}

  Opener opener() override { return opener_; }
  const std::string& description() const override { return description_; }
  void start() override {}
  void shutdown() override {}

 private:
  const Opener opener_;
  const std::string description_;
};

OpenedLine open(const SerialSettings& settings) {
  const Result<int> port = open_serial(settings);
  if (!port) return tl::unexpected(port.error());
  if (const auto warning = ask_for_low_latency(*port, settings.path)) spdlog::warn("{}", *warning);
  return Descriptor(*port);
}

// On a thread, since an adapter that hangs may keep its driver busy for seconds.
std::unique_ptr<Line> make_serial(const SerialSettings& settings) {
  return std::make_unique<OutsideLine>(opener_on_thread([settings] { return open(settings); }),
                                       fmt::format("{} at {} baud", settings.path, settings.baud));
}

std::unique_ptr<Line> make_tcp(const TcpSettings& settings, const stage::Profile& profile) {
  return std::make_unique<OutsideLine>(tcp_opener(settings),
                                       fmt::format("tcp {} at {} baud", to_string(settings), profile.baud));
}

class SimulatedLine final : public Line {
 public:
  SimulatedLine(Pacing pacing, const stage::Kind& kind, const stage::Words& options, Strand strand,
                std::string description)
      : description_(std::move(description)),
        runner_(std::move(strand)),
        device_(pacing, runner_, [this, &kind, &options](ByteLink& inside) -> std::unique_ptr<LineMachine> {
          auto simulated = kind.make_simulation(options, inside);
          simulation_ = simulated.get();
          return simulated;
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
  stage::Simulation* simulation_ = nullptr;  // inside device_
  PacedLine device_;
};

std::unique_ptr<Line> make_simulated(const SimulatedConnection& connection, const DeviceConfig& config, Strand strand) {
  const Pacing pacing{connection.paced ? config.profile.baud : 0, Duration{}, connection.speed};
  return std::make_unique<SimulatedLine>(pacing, *config.kind, connection.options, std::move(strand),
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
  if (const auto* tcp = std::get_if<TcpSettings>(&config.connection)) return make_tcp(*tcp, config.profile);
  return make_simulated(std::get<SimulatedConnection>(config.connection), config, std::move(strand));
}

}  // namespace axisgate::server
