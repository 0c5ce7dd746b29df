#include "tests/stress/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "device/link/clock.h"
#include "server/kinds.h"

namespace axisgate::stress {
namespace {

namespace simulator = shrc203::simulator;
using std::chrono::milliseconds;

std::filesystem::path make_directory() {
  std::string name = std::filesystem::temp_directory_path() / "axisgate-stress-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
  return name;
}

simulator::Options unit_options(std::size_t device) {
  simulator::Options options;
  options.serial_number = serial_number(device);
  options.firmware = firmware(device);
  for (int axis = 1; axis <= 3; ++axis) {
    simulator::AxisSetup& setup = options.axes[static_cast<std::size_t>(axis - 1)];
    setup.nm_per_pulse_e6 = nm_per_pulse(device, axis) * std::int64_t{1'000'000};
    setup.maximum_speed = maximum_speed(device, axis);
  }
  return options;
}

int number_of(std::size_t device, int axis) { return static_cast<int>(device) * 3 + axis; }

}  // namespace

std::string device_name(std::size_t device) { return fmt::format("stage{}", device + 1); }
std::string serial_number(std::size_t device) { return fmt::format("210600{:04}", 1001 + device); }
std::string firmware(std::size_t device) { return fmt::format("V2.00.{:03}", device); }
int nm_per_pulse(std::size_t device, int axis) { return 10 + number_of(device, axis); }
int maximum_speed(std::size_t device, int axis) { return 50'000 + 100 * number_of(device, axis); }

Bench::Bench() : directory_(make_directory()) {
  for (std::size_t device = 0; device < kDevices; ++device) plug(device);
  gateway_ = std::make_unique<server::Gateway>(config(), 1);
}

Bench::~Bench() {
  gateway_.reset();
  for (auto& unit : units_) unit.reset();
  if (testing::Test::HasFailure()) {
    fmt::print("What went over the lines is kept in {}\n", directory_.string());
  } else {
    std::filesystem::remove_all(directory_);
  }
}

server::Config Bench::config() const {
  server::Config config;
  for (std::size_t device = 0; device < kDevices; ++device) {
    server::DeviceConfig one = server::default_config(server::device_kinds()).devices[0];
    auto& stage = std::get<server::StageConfig>(one.family);
    one.name = device_name(device);
    stage.profile.serial_number = serial_number(device);
    // The axes of the simulator move independently; one device uses that.
    if (device == 0) stage.kind_settings["busy_scope"] = "axis";
    one.baud = 4'000'000;
    stage.profile.idle_poll = milliseconds(20);
    stage.profile.moving_poll = milliseconds(10);
    one.connection = SerialSettings{path(device), 4'000'000, Parity::none, 1, FlowControl::none};
    one.record = recording_path(device);
    config.devices.push_back(std::move(one));
  }
  return config;
}

std::string Bench::recording(std::size_t device) const {
  std::stringstream text;
  text << std::ifstream(recording_path(device)).rdbuf();
  return text.str();
}

void Bench::plug(std::size_t device) {
  units_[device] = std::make_unique<PluggedUnit>(path(device), unit_options(device));
}

bool Bench::wait_until_link(std::size_t number, bool up) {
  const TimePoint limit = monotonic_now() + std::chrono::minutes(1);
  while ((device(number).newest_state().get().value->link == stage::LinkState::up) != up) {
    if (monotonic_now() > limit) return false;
    std::this_thread::sleep_for(milliseconds(1));  // pause between two checks; the limit above decides
  }
  return true;
}

bool Bench::wait_until_all_up() {
  bool all = true;
  for (std::size_t device = 0; device < kDevices; ++device) all = all && wait_until_link(device, true);
  return all;
}

}  // namespace axisgate::stress
