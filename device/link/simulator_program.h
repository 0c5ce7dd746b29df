// Parts that the programs of simulated devices share.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/control_language.h"
#include "device/core/named_options.h"
#include "device/core/paced_line.h"
#include "device/core/problem.h"
#include "device/core/simulation.h"
#include "device/link/control_server.h"
#include "device/link/socket_file.h"

namespace axisgate {

// Exit codes
inline constexpr int kSimulatorFailed = 1;
inline constexpr int kSimulatorUsage = 2;

// Prints the problem as an error of `program`. Returns the exit code.
int complain(std::string_view program, int exit_code, const Problem& problem);
int complain_of_usage(std::string_view program, std::string message);

void print_options(std::span<const OptionName> options);

// Calls `set` with each NAME=VALUE of --option. Fails with invalid_request.
Result<void> set_options(const std::vector<std::string>& settings,
                         const std::function<Result<void>(std::string_view name, std::string_view value)>& set);

// Opens the control socket; nullopt without a path.
Result<std::optional<SocketFile>> open_control(const std::string& path);

// A simulated device with its line and its control socket. `Line` has attach(), post(), strand()
// and shutdown(), as PtyLine. Not thread safe.
template <class Line>
class SimulatedDevice {
 public:
  using Factory = std::function<std::unique_ptr<Simulation>(ByteLink& inside)>;

  // The caller starts the line.
  SimulatedDevice(const Pacing& pacing, std::shared_ptr<Line> line, const Factory& make)
      : line_(std::move(line)), paced_(pacing, *line_, [&](ByteLink& inside) -> std::unique_ptr<LineMachine> {
          auto made = make(inside);
          simulation_ = made.get();
          return made;
        }) {
    line_->attach(paced_);
  }

  void take_commands(Descriptor listener) {
    server_ = std::make_shared<ControlServer>(
        line_->strand(), std::move(listener), [this](const std::string& command, ControlServer::Reply reply) {
          line_->post([this, command, reply = std::move(reply)](TimePoint now) { reply(carry_out(command, now)); });
        });
    server_->start();
  }

  void shutdown() {
    if (server_) server_->shutdown();
    line_->shutdown();
  }

 private:
  std::string carry_out(const std::string& command, TimePoint now) {
    std::string reply;
    paced_.touch(now, [&](TimePoint device_now) { reply = control_reply(simulation_->operate(command, device_now)); });
    return reply;
  }

  std::shared_ptr<Line> line_;
  Simulation* simulation_ = nullptr;  // owned by paced_
  PacedLine paced_;
  std::shared_ptr<ControlServer> server_;
};

}  // namespace axisgate
