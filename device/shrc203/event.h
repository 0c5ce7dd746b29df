// What a controller tells: facts, each delivered once and in order, and news of the newest state.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "device/core/lane.h"
#include "device/shrc203/motion.h"
#include "device/shrc203/state.h"

namespace axisgate::shrc203 {

// A motion began, changed its state or ended.
struct MotionChanged {
  Motion motion;
};

// An axis number came over the line by itself. `motion` is 0 when none of ours was waiting for it.
struct CompletionSeen {
  int axis = 0;
  MotionId motion = 0;
};

struct PathProgress {
  enum class Step { sent, started, done, underrun };
  MotionId motion = 0;
  Step step = Step::sent;
  int segment = 0;         // counts from 1
  std::string wire_reply;  // OK or OK_D, where the step is a sent one
};

struct LinkChanged {
  LinkState link = LinkState::down;
  std::string why;
};

struct StopRequested {
  AxisSet axes;
  bool emergency = false;
  std::string who;
};

// One exchange on the line ended. For metrics and the live view of the line; not a fact with a revision.
struct ExchangeEnded {
  enum class Outcome { ok, ok_d, ng, ng_i, data, timed_out, garbled, link_lost };
  std::string_view command;  // the table's name for the row
  std::string line, reply;
  Lane lane = Lane::question;
  Outcome outcome = Outcome::ok;
  Duration latency{};   // from the write to the reply's last byte
  bool closed = false;  // the reply was known only when an !:S behind it had been answered
};
std::string_view name(ExchangeEnded::Outcome outcome);  // "ok", "ok_d", "timed_out", ..., as metric labels have it

struct BarrierEntered {
  std::string why;
};

// A line that nothing waited for: dropped, and counted. Device text: escape before showing.
struct UnexpectedLine {
  std::string text;
};

// Positions, mode, excitation or the like are newer; ask Controller::state().
struct StateChanged {};

using Event = std::variant<MotionChanged, CompletionSeen, PathProgress, LinkChanged, StopRequested, ExchangeEnded,
                           BarrierEntered, UnexpectedLine, StateChanged>;

class EventSink {
 public:
  virtual ~EventSink() = default;
  // Called on the controller's strand; must not call back into the controller.
  virtual void on_event(const Event& event, TimePoint now) = 0;
};

}  // namespace axisgate::shrc203
