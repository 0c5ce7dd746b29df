// What a controller reports: facts, each delivered once and in order, and that there is a newer state.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "device/core/lane.h"
#include "device/stage/condition.h"
#include "device/stage/motion.h"
#include "device/stage/state.h"
#include "device/stage/stop.h"

namespace axisgate::stage {

// A motion began, changed its state or ended.
struct MotionChanged {
  Motion motion;
};

// A completion was received. `motion` is 0 when none of ours was waiting for it.
struct CompletionSeen {
  int axis = 0;
  MotionId motion = 0;
  bool deduced = false;  // from two answers that agree, not when it came in
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
  AxisSet controllable{};       // when up
  std::string serial_number{};  // of the controller, when up
};

struct StopRequested {
  AxisSet axes;
  bool emergency = false;
  std::string who;
  bool moved = false;      // something moved, or waited to
  std::int64_t count = 1;  // identical stops by the same caller since the last of these events
};

// A stop has another state, or another caller. It is a fact once the stop is no longer open; until then the event only
// keeps the record of open stops current.
struct StopChanged {
  Stop stop;
};

// An emergency stop latched the device, or ClearErrors by `who` lifted the latch.
struct EmergencyLatchChanged {
  std::optional<EmergencyLatch> latch;  // nullopt: lifted
  std::string who;
};

// Axes move that the gateway did not start: the front panel did, or a gateway before this one.
struct ForeignMotion {
  AxisSet axes;
};

// A condition of the stage has begun or ended. Nobody here need have caused that: a person at the front panel may have,
// a sensor, an error, or a request of before.
struct ConditionChanged {
  Condition condition{};
  AxisSet axes{};  // empty: of the whole controller
  bool begun = true;
  std::string value{};  // the mode or the command format
  TimePoint before{};   // the last reading that did not show it; TimePoint{}: there was none
  TimePoint seen{};     // the first reading that did
};

// What became of the motions of a run that was killed (unfinished.h). For the log; not a fact with a revision.
struct UnfinishedJudged {
  enum class What {
    not_ours,    // another controller answers, or another program has used the line since
    stopped,     // these axes are being stopped
    finishes,    // these axes may finish
    stationary,  // all axes were seen to be stationary
  };
  What what = What::not_ours;
  AxisSet axes;
  std::string motions;
};

// A visit to their edit mode has changed memory switches for good (manual 117) MS:ON).
struct SwitchesChanged {
  struct Change {
    int item = 0, number = 0;  // 0 to 8 (manual 119)); from 0
    std::string before, after;
  };
  std::string who;
  std::vector<Change> changes;  // by item and number
  bool unknown = false;         // some may be others, too: the line was lost, or the controller did not tell
};

// The controller's program reported something unasked (manual 109) P:C, 110) P:T).
struct ProgramNotice {
  enum class Kind { ended, trigger };
  Kind kind = Kind::ended;
  std::int64_t count = 1;  // how often it was reported since the last of these
};

// A line is about to be written, its CR LF included. For the recorder and metrics, as are the other events of the line
// itself.
struct BytesWritten {
  std::string bytes;
  // Counts from 1 with each command sent, and belongs to what closes it, too. 0: a probe that belongs to none.
  std::uint64_t exchange = 0;
  std::string who;  // who requested it; empty: the line itself
  Lane lane = Lane::question;
  AxisSet completes{};    // the axes whose numbers may come from now on
  MotionId motion = 0;    // whose line it is; 0: of none
  bool closed = false;    // an !:S follows an answer that could be such a number
  bool question = false;  // it changes nothing
  AxisSet axes{};         // that the line is about; of a question: empty
};

// What came in, cut as the driver cut it.
struct BytesReceived {
  std::string bytes;
};

// A time ran out: of a reply, of a probe in a barrier, or of a command that waited to be sent.
struct TimeLimitPassed {
  enum class Kind { reply, probe, queue };
  Kind kind = Kind::reply;
};
std::string_view name(TimeLimitPassed::Kind kind);  // "reply", "probe", "queue", as metric labels have it

// One exchange on the line ended. For metrics and the live view of the line; not a fact with a revision.
struct ExchangeEnded {
  enum class Outcome { ok, ok_d, ng, ng_i, data, timed_out, garbled, link_lost };
  std::string_view command;  // the table's name for the row
  std::string line, reply;
  Lane lane = Lane::question;
  Outcome outcome = Outcome::ok;
  Duration latency{};          // from the write to the reply's last byte
  bool closed = false;         // the reply was known only when an !:S behind it had been answered
  std::uint64_t exchange = 0;  // as in BytesWritten
  std::string who;             // who asked first; empty: the line itself
  Duration waited{};           // from the asking to the write
};
std::string_view name(ExchangeEnded::Outcome outcome);  // "ok", "ok_d", "timed_out", ..., as metric labels have it

struct BarrierEntered {
  std::string why;
};

// What became known of the line, where it changes what may be sent, or what a number that comes may mean.
struct LineLearned {
  enum class What {
    barrier_passed,   // also the one after a connect
    same_controller,  // a suspected restart was none
    ready,            // the axes are stationary: their numbers may come for a little longer
    busy,             // they are not
  };
  What what = What::barrier_passed;
  AxisSet axes{};  // of ready and busy
};

// A line that nothing waited for: dropped, and counted. Device text: escape before showing.
struct UnexpectedLine {
  std::string text;
};

// A state machine was given an event that its table does not have: an internal error of the gateway. Its line is
// disconnected, and everything is stopped.
struct IllegalTransition {
  std::string_view machine, state, event;
};

// Positions, mode, excitation or the like are newer; ask StageController::state().
struct StateChanged {};

using Event = std::variant<MotionChanged, CompletionSeen, PathProgress, LinkChanged, StopRequested, StopChanged,
                           EmergencyLatchChanged, ForeignMotion, ConditionChanged, SwitchesChanged, ProgramNotice,
                           BytesWritten, BytesReceived, TimeLimitPassed, ExchangeEnded, BarrierEntered, LineLearned,
                           UnexpectedLine, IllegalTransition, UnfinishedJudged, StateChanged>;

class EventSink {
 public:
  virtual ~EventSink() = default;
  // Called on the controller's strand; must not call back into the controller.
  virtual void on_event(const Event& event, TimePoint now) = 0;
  // Whether somebody follows the state as it changes. If nobody does, it is read less often. As on_event().
  virtual bool state_followed() const { return true; }
};

}  // namespace axisgate::stage
