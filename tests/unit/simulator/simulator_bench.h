// A simulated SHRC-203 in virtual time, with its output and the times of the output.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/shrc203/simulator/simulator.h"

namespace axisgate::shrc203::simulator {

// Option names and the values to set.
using Settings = std::vector<std::pair<std::string_view, std::string_view>>;

class SimulatorBench : private ByteLink {
 public:
  struct Said {
    std::string line;
    Duration at;  // since the bench began
    friend bool operator==(const Said&, const Said&) = default;
  };

  explicit SimulatorBench(const Settings& settings = {}, Options options = {})
      : device(with(std::move(options), settings), *this) {
    device.link_up(now_);
  }

  // Returns everything the device writes at this instant in answer to one line, with a blank between lines instead of
  // CR LF.
  std::string ask(std::string_view line) { return send(std::string(line) + "\r\n"); }

  std::string send(std::string_view bytes) {
    device.receive(bytes, now_);
    return heard();
  }

  // Runs from event to event for `time`, and returns the output.
  std::string wait(Duration time) {
    const TimePoint until = now_ + time;
    for (auto next = device.next_deadline(); next && *next <= until; next = device.next_deadline()) step(*next);
    step(until);
    return heard();
  }

  // Runs until no event is due, and returns the output.
  std::string rest() {
    for (auto next = device.next_deadline(); next; next = device.next_deadline()) step(*next);
    return heard();
  }

  SimulatorBench(const SimulatorBench&) = delete;
  SimulatorBench& operator=(const SimulatorBench&) = delete;

  TimePoint now() const { return now_; }
  Duration elapsed() const { return now_ - TimePoint{}; }
  const std::vector<Said>& said() const { return said_; }
  Duration when_last_said() const { return said_.back().at; }

 private:
  static Options with(Options options, const Settings& settings) {
    for (const auto& [name, value] : settings) {
      if (!options.set(name, value)) throw std::invalid_argument(std::string(name));
    }
    return options;
  }

  void step(TimePoint time) {
    now_ = time;
    device.advance(time);
  }

  std::string heard() { return std::exchange(heard_, {}); }

  void write(std::string_view bytes) override {
    const std::string line(bytes.substr(0, bytes.size() - 2));
    if (!bytes.ends_with("\r\n")) throw std::logic_error("a line without CR LF: " + std::string(bytes));
    heard_ += heard_.empty() ? line : " " + line;
    said_.push_back({line, now_ - TimePoint{}});
  }

  void reopen(Duration) override {}

  TimePoint now_{};
  std::string heard_;
  std::vector<Said> said_;

 public:
  Simulator device;
};

}  // namespace axisgate::shrc203::simulator
