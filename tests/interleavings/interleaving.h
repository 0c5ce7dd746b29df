// Minimal device that executes commands, so that replies and axis numbers can arrive in every possible order. A
// question has two parts: its answer, and the axes that have not yet reported the end of their motion.
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

// Choices enumerates all decisions of a procedure that can be run repeatedly. Each run repeats the decisions of the
// previous run, except the last decision that still had another option.
class Choices {
 public:
  std::size_t choose(std::size_t options);  // returns 0 to options - 1
  bool another();                           // begins the next run; returns false if there is none

 private:
  struct Decision {
    std::size_t chosen, options;
  };
  std::vector<Decision> decisions_;
  std::size_t next_ = 0;
};

// A Question is the situation before the lines arrive in one of the orders.
struct Question {
  // Time at which the question is asked: while the axes move, and their motion ends before or after the question's time
  // limit; or `after_ready` after a reading that reported them stationary.
  enum class Moment { moving, moving_beyond_its_time, standing };

  const shrc203::CommandRow* row = nullptr;
  int value = 0;  // answer of the device; if it has several axes, the value for the lowest
  stage::AxisSet controllable, moving;
  Moment moment = Moment::moving;
  Duration after_ready{};
  bool by_execute = false;  // the motion comes from a caller's Execute, so that more motions may follow in it
  bool shared = false;      // two callers ask while the line is occupied, so that one exchange answers both

  std::vector<std::string> lines() const;  // lines for Execute
  std::string on_the_wire() const;
  std::string reply() const;   // line that the device sends
  std::string answer() const;  // answer that the caller receives
  // Reports whether the question must wait until no axis number can arrive that looks like its answer.
  bool waits() const;
  std::string description() const;
};

// Returns the values worth testing: 1, 2 and 3 if the row can answer them, and one value that is no axis number.
std::vector<int> values_of(const shrc203::CommandRow& row);

// An Interleaving is one run: connection, motion, question, and all axis numbers, in the chosen order.
class Interleaving : public ByteLink, public stage::EventSink {
 public:
  Interleaving(const Question& question, Choices& choices);
  ~Interleaving() override;

  // Runs it and returns the first error; empty if there was none.
  std::string run();
  // Returns the received lines in order, beginning with "asked" for the question. Axis numbers appear as numbers; "+"
  // marks a line that arrived in one piece with the line before it.
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
  // Runs until `done` returns true, an error occurs, or `limit` has passed. Returns the result of `done`.
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
  bool started_ = false, busy_ = false, away_ = false, closed_ = false;  // state of the device and of its line
  bool asked_ = false, over_ = false;                                    // state of the question
  int readings_since_asked_ = 0;
  stage::AxisSet outstanding_;
  std::optional<TimePoint> ready_seen_, asked_at_, written_at_;
  std::optional<stage::Motion> outcome_;
  std::map<int, int> told_, seen_;  // for each axis: numbers sent by the device, and numbers counted by the gateway
  struct Caller {
    std::vector<std::string> answers;
    std::optional<Reason> problem;
    bool ended = false;
  };
  std::vector<Caller> callers_;
};

}  // namespace axisgate::simulation
