// The simulated mill in virtual time, with its record.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/rml1/simulator/simulator.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1::simulator {

// Returns the setup with options set, given as names and values.
inline MillSetup with_options(const std::vector<std::pair<std::string_view, std::string_view>>& options,
                              MillSetup setup = {}) {
  for (const auto& [name, value] : options) {
    if (!setup.options.set(name, value)) throw std::invalid_argument(std::string(name));
  }
  return setup;
}

// A MillBench has the test_profile() unless its setup has another. The work origin is 100 mm from the home corner, and
// Z0 50 mm below the top: X and Y from -10000 to 50500, Z from -1050 to 5000. The tool is at the work origin and at the
// top. Z2 is the top, Z1 is -100; the spindle needs 2 s.
class MillBench : private ByteLink {
 public:
  explicit MillBench(MillSetup setup = {})
      : mill(completed(std::move(setup)), *this, [this](std::string_view line) { lines.emplace_back(line); }) {
    mill.set_origin(10000, 10000, now);
    mill.set_z0(-5000, now);
    send("!MC0;H;!MC1;");
    finish();
    lines.clear();
    written.clear();
  }

  // Delivers bytes at the present time.
  void send(std::string_view bytes) { mill.receive(bytes, now); }

  void wait_ms(int time) {
    now += std::chrono::milliseconds(time);
    mill.advance(now);
  }

  // Runs until nothing more happens without a command.
  void finish() {
    for (auto next = mill.next_deadline(); next; next = mill.next_deadline()) {
      now = *next;
      mill.advance(now);
    }
  }

  // Returns the duration of a job, in milliseconds.
  double time_ms(std::string_view job) {
    const TimePoint before = now;
    send(job);
    finish();
    return std::chrono::duration<double, std::milli>(now - before).count();
  }

  std::string tool() {
    const Machine::Point at = mill.state(now).tool;
    return fmt::format("{:g} {:g} {:g}", at.x, at.y, at.z);
  }

  std::string errors() { return mill.state(now).errors; }

  // Returns the text after the time in each recorded line that has `key`.
  std::vector<std::string> recorded(const std::string& key) const {
    std::vector<std::string> found;
    for (const std::string& line : lines) {
      if (line.find("\"" + key + "\":") == std::string::npos) continue;
      const auto begin = line.find(',') + 1;
      found.push_back(line.substr(begin, line.size() - begin - 1));
    }
    return found;
  }

  std::vector<std::string> lines;
  std::string written;  // bytes written to the host
  TimePoint now{};
  Simulator mill;

 private:
  static MillSetup completed(MillSetup setup) {
    if (setup.profile.name.empty()) setup.profile = test_profile();
    return setup;
  }

  void write(std::string_view bytes) override { written += bytes; }
  void reopen(Duration) override {}
};

}  // namespace axisgate::rml1::simulator
