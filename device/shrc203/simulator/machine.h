// The controller as its line sees it: lines in, replies and completion characters out, in their order.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/shrc203/simulator/line_cutter.h"
#include "device/shrc203/simulator/rig.h"
#include "device/shrc203/simulator/setters.h"

namespace axisgate::shrc203::simulator {

class Machine {
 public:
  // How long a reboot (manual 46) RESET:) takes; nothing is read or answered meanwhile.
  static constexpr Duration kBoot = std::chrono::seconds(1);
  // received() keeps this many lines at least, and at most twice as many.
  static constexpr std::size_t kReceivedKept = 100'000;

  Machine(Options options, ByteLink& line) : rig_(std::move(options)), line_(line) {}

  void receive(std::string_view bytes, TimePoint now);
  void advance(TimePoint now);
  void forget_unfinished_line() { cutter_.clear(); }
  void reboot(TimePoint now);
  void send_completions();

  Rig& rig() { return rig_; }
  const Rig& rig() const { return rig_; }
  const std::vector<std::string>& received() const { return received_; }

 private:
  void handle(const LineCutter::Line& line);
  void remember(const std::string& text);
  void respond(const std::string& command, const std::string& as_sent);
  std::optional<std::string> answer_question(std::string_view command) const;
  bool knows(std::string_view command) const;
  void send(std::string_view text);

  Rig rig_;
  ByteLink& line_;
  LineCutter cutter_;
  std::vector<std::string> received_;
  std::optional<TimePoint> boots_until_;
};

}  // namespace axisgate::shrc203::simulator
