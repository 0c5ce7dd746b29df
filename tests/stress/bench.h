// A whole gateway below gRPC, and the devices that it serves at real pseudo terminals.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "server/gateway.h"
#include "tests/stress/plugged_unit.h"

namespace axisgate::stress {

inline constexpr std::size_t kDevices = 3;

// What the controllers answer: no two alike, so that an answer to another's question shows.
std::string device_name(std::size_t device);
std::string serial_number(std::size_t device);
std::string firmware(std::size_t device);
int nm_per_pulse(std::size_t device, int axis);
int maximum_speed(std::size_t device, int axis);

class Bench {
 public:
  // The gateway is made and not started; all units are plugged in.
  Bench();
  // First the gateway ends, then the units.
  ~Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  server::Gateway& gateway() { return *gateway_; }
  server::Stage& device(std::size_t number) { return *gateway_->stages()[number]; }
  void end_gateway() { gateway_.reset(); }
  // The file to which the gateway records the device's line.
  std::string recording(std::size_t device) const;

  void unplug(std::size_t device) { units_[device].reset(); }
  void plug(std::size_t device);

  // Every wait has a limit that only a failing test reaches.
  [[nodiscard]] bool wait_until_link(std::size_t device, bool up);
  [[nodiscard]] bool wait_until_all_up();

 private:
  server::Config config() const;
  std::string path(std::size_t device) const { return directory_ / device_name(device); }
  std::string recording_path(std::size_t device) const { return path(device) + ".recording"; }

  std::filesystem::path directory_;
  std::array<std::unique_ptr<PluggedUnit>, kDevices> units_;
  std::unique_ptr<server::Gateway> gateway_;
};

}  // namespace axisgate::stress
