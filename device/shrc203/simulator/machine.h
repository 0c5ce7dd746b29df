// The controller as its line sees it: lines in, replies and completion characters out, in their order.
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
  // received() keeps this many lines at least, and at most twice as many.
  static constexpr std::size_t kReceivedKept = 100'000;
  // So many unanswered lines are kept while it is slow or stuck; more are lost.
  static constexpr std::size_t kWaitingMax = 1000;

  Machine(Options options, ByteLink& line) : rig_(std::move(options)), line_(line) {}

  void receive(std::string_view bytes, TimePoint now);
  void advance(TimePoint now);
  void forget_unfinished_line() { cutter_.clear(); }
  void reboot(TimePoint now);
  void set_boot(Boot boot) { boot_ = std::move(boot); }
  // Every line is carried out and answered so much after it came, or after its predecessor was.
  void set_answer_delay(Duration delay) { answer_delay_ = delay; }
  // Until then what comes and what is written is lost; the device notices nothing.
  void be_unplugged(TimePoint until) { unplugged_until_ = until; }
  // Until then lines are read but neither carried out nor answered, and no completion is sent.
  void be_stuck(TimePoint until) { stuck_until_ = until; }
  void send_completions();
  std::optional<TimePoint> next_event() const;
  bool answering() const { return answering_; }  // what is being written answers a line

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
