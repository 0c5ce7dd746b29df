// A device of a few lines that executes its commands, so that replies and axis numbers come in every order there is. A
// question has two parts: what the answer says, and which axes have yet to report that their motion has ended.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/shrc203/command/command_table.h"
#include "device/shrc203/controller.h"

namespace axisgate::simulation {

// Goes through all decisions of something that can be run again and again: each run decides as the one before it, but
// for the last decision of which something was left to choose.
class Choices {
 public:
  std::size_t choose(std::size_t options);  // 0 to options - 1
  bool another();                           // begins the next run; false when there is none

 private:
  struct Decision {
    std::size_t chosen, options;
  };
  std::vector<Decision> decisions_;
  std::size_t next_ = 0;
};

// What there is before the lines come in some order.
struct Question {
  // When it is asked: while the axes move, and their motion ends before its time runs out or after; or `after_ready`
  // later than a reading that reported them stationary.
  enum class Moment { moving, moving_beyond_its_time, standing };

  const shrc203::CommandRow* row = nullptr;
  int value = 0;  // what the device answers; of several axes, for the lowest
  stage::AxisSet controllable, moving;
  Moment moment = Moment::moving;
  Duration after_ready{};
  bool by_execute = false;  // the motion is a caller's own line, so that more motions may follow in it
  bool shared = false;      // two callers ask at once while the line is taken, so that one exchange answers both

  std::vector<std::string> lines() const;  // of Execute
  std::string on_the_wire() const;
  std::string reply() const;   // the device's line
  std::string answer() const;  // the caller's
  // Whether the table lets it wait until no axis number can come that could be its answer.
  bool waits() const;
  std::string description() const;
};

// The values that tell something: 1, 2 and 3 where the row can answer them, and one that is no axis number.
std::vector<int> values_of(const shrc203::CommandRow& row);

// One run: a connect, a motion, the question, and all axis numbers, in the order that is chosen.
class Interleaving : public ByteLink, public stage::EventSink {
 public:
  Interleaving(const Question& question, Choices& choices);
  ~Interleaving() override;

  // What was wrong; empty when nothing was.
  std::string run();
  // The lines as they came in since the question, behind "asked"; axis numbers by themselves, and with a "+" what came
  // in one piece with the line before it.
  const std::string& order() const { return order_; }

 private:
  struct Reply {
    TimePoint due;
    std::string command, text;
  };

  void write(std::string_view bytes) override;
  void reopen(Duration wait) override;
  void on_event(const stage::Event& event, TimePoint now) override;

  std::string answer_to(const std::string& line);
  std::string of_each_axis(std::string_view field) const;
  std::string of_each_axis_ready() const;
  bool begin();
  void ask();
  void execute(std::vector<std::string> lines, shrc203::Controller::OnExecute heard);
  void heard(std::size_t caller, const stage::ExecuteEvent& event);
  void end();
  void check();
  void wrong(const std::string& what);

  void step(TimePoint limit);
  // Until `done` holds, or something is wrong; false when `limit` passed first.
  template <class Done>
  bool run_until(const Done& done, Duration limit) {
    const TimePoint end = now_ + limit;
    while (!done() && now_ < end && failure_.empty()) step(end);
    return done();
  }
  void run_for(Duration duration) {
    (void)run_until([] { return false; }, duration);
  }
  void deliver(const Reply& reply);
  bool may_complete() const;
  std::optional<int> chosen_axis();
  std::string number_of(int axis);

  const Question& question_;
  Choices& choices_;
  const std::string wire_line_;
  std::string failure_, order_;
  TimePoint now_{};
  std::unique_ptr<shrc203::Controller> controller_;
  std::deque<Reply> replies_;
  std::string partial_, line_before_ = "L:E";
  bool started_ = false, busy_ = false, away_ = false, closed_ = false;  // what the device does, and its line
  bool asked_ = false, over_ = false;                                    // the question
  int readings_since_asked_ = 0;
  stage::AxisSet outstanding_;
  std::optional<TimePoint> ready_seen_, asked_at_, written_at_;
  std::optional<stage::Motion> outcome_;
  std::map<int, int> told_, seen_;  // by axis: numbers that the device has sent, and that the gateway has counted
  struct Caller {
    std::vector<std::string> answers;
    std::optional<Reason> problem;
    bool ended = false;
  };
  std::vector<Caller> callers_;
};

}  // namespace axisgate::simulation
