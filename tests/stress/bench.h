// Complete gateway below gRPC, with simulated devices at real pseudo terminals.
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

// Properties of the controllers, all different, so that an answer to the question of another caller is detected.
std::string device_name(std::size_t device);
std::string serial_number(std::size_t device);
std::string firmware(std::size_t device);
int nm_per_pulse(std::size_t device, int axis);
int maximum_speed(std::size_t device, int axis);

class Bench {
 public:
  // Creates the gateway without starting it, and plugs in all units.
  Bench();
  // Ends the gateway first, then the units.
  ~Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  server::Gateway& gateway() { return *gateway_; }
  server::Stage& device(std::size_t number) { return *gateway_->stages()[number]; }
  void end_gateway() { gateway_.reset(); }
  // Returns the text that the gateway has recorded from the device's line.
  std::string recording(std::size_t device) const;

  void unplug(std::size_t device) { units_[device].reset(); }
  void plug(std::size_t device);

  // Both functions wait with a limit that only a failing test reaches.
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
