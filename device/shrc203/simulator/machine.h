// The controller as seen on its line: lines in, replies and completions out, in order.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/line_machine.h"
#include "device/shrc203/simulator/boot.h"
#include "device/shrc203/simulator/commands/setters.h"
#include "device/shrc203/simulator/line_cutter.h"
#include "device/shrc203/simulator/rig.h"

namespace axisgate::shrc203::simulator {

class Machine {
 public:
  // Number of lines that received() keeps at least; it keeps at most twice as many.
  static constexpr std::size_t kReceivedKept = 100'000;
  // Number of unanswered lines kept while the device is slow or stuck; further ones are lost.
  static constexpr std::size_t kWaitingMax = 1000;

  Machine(Options options, ByteLink& line) : rig_(std::move(options)), line_(line) {}

  void receive(std::string_view bytes, TimePoint now);
  void advance(TimePoint now);
  void forget_unfinished_line() { cutter_.clear(); }
  void reboot(TimePoint now);
  void set_boot(Boot boot) { boot_ = std::move(boot); }
  // Delays each line: it is carried out and answered `delay` after it arrived, or after the previous line was due.
  void set_answer_delay(Duration delay) { answer_delay_ = delay; }
  // Loses all received and written bytes until then; the device does not notice.
  void be_unplugged(TimePoint until) { unplugged_until_ = until; }
  // Reads lines until then, but neither carries them out nor answers them, and sends no completion.
  void be_stuck(TimePoint until) { stuck_until_ = until; }
  void send_completions();
  std::optional<TimePoint> next_event() const;
  bool answering() const { return answering_; }  // the bytes being written answer a line

  Rig& rig() { return rig_; }
  const Rig& rig() const { return rig_; }
  const std::vector<std::string>& received() const { return received_; }

 private:
  struct Waiting {
    LineCutter::Line line;
    TimePoint due{};
  };

  void take(LineCutter::Line line);
  void run_to(TimePoint now);
  void restart();
  void handle(const LineCutter::Line& line);
  void remember(const std::string& text);
  void respond(const std::string& command, const std::string& as_sent);
  std::optional<std::string> answer_question(std::string_view command) const;
  bool knows(std::string_view command) const;
  void reply(std::string_view text);
  void send(std::string_view text);

  Rig rig_;
  ByteLink& line_;
  LineCutter cutter_;
  std::vector<std::string> received_;
  std::deque<Waiting> waiting_;
  Boot boot_;
  std::optional<TimePoint> boots_until_;
  Duration answer_delay_{};
  TimePoint stuck_until_{};
  TimePoint unplugged_until_{};
  bool answering_ = false;
};

}  // namespace axisgate::shrc203::simulator
