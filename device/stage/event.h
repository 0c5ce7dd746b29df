// Events of a controller: facts, each delivered once and in order, and notifications of a newer state.
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

// A completion was received. `motion` is 0 if no motion of the gateway waited for it.
struct CompletionSeen {
  int axis = 0;
  MotionId motion = 0;
  bool deduced = false;  // deduced later from two answers that agree, not recognised on arrival
};

struct PathProgress {
  enum class Step { sent, started, done, underrun };
  MotionId motion = 0;
  Step step = Step::sent;
  int segment = 0;         // from 1
  std::string wire_reply;  // OK or OK_D, for Step::sent
};

struct LinkChanged {
  LinkState link = LinkState::down;
  std::string why;
  AxisSet controllable{};       // if the link is up
  std::string serial_number{};  // serial number of the controller, if the link is up
};

struct StopRequested {
  AxisSet axes;
  bool emergency = false;
  std::string who;
  bool moved = false;      // an axis moved, or a motion waited
  std::int64_t count = 1;  // identical stops by the same caller since the last StopRequested event
};

// The state or the callers of a stop changed. The event is a fact once the stop is no longer open; until then it only
// keeps the record of open stops current.
struct StopChanged {
  Stop stop;
};

// An emergency stop latched the device, or ClearErrors by `who` lifted the latch.
struct EmergencyLatchChanged {
  std::optional<EmergencyLatch> latch;  // nullopt: lifted
  std::string who;
};

// Axes move that this gateway did not start: the front panel did, or an earlier run of the gateway.
struct ForeignMotion {
  AxisSet axes;
};

// A condition of the stage began or ended. The cause may be a person at the front panel, a sensor, an error, or an
// earlier request.
struct ConditionChanged {
  Condition condition{};
  AxisSet axes{};  // empty: of the whole controller
  bool begun = true;
  std::string value{};  // mode or command format
  TimePoint before{};   // time of the last reading without the change; TimePoint{}: there was none
  TimePoint seen{};     // time of the first reading with the change
};

// The gateway's decision about the motions of a run that was killed (unfinished.h). For the log; not a fact with a
// revision.
struct UnfinishedJudged {
  enum class What {
    not_ours,    // another controller answers, or another program has used the line since then
    stopped,     // these axes are being stopped
    finishes,    // these axes may finish
    stationary,  // all axes were confirmed stationary
  };
  What what = What::not_ours;
  AxisSet axes;
  std::string motions;
};

// Memory switches, which a controller keeps without power, were changed in a visit to their edit mode.
struct SwitchesChanged {
  struct Change {
    int item = 0, number = 0;  // as the controller counts them, from 0
    std::string before, after;
  };
  std::string who;
  std::vector<Change> changes;  // by item and number
  bool unknown = false;  // more switches may have changed: the line was lost, or the controller did not report them
};

// The program stored in the controller sent a notice.
struct ProgramNotice {
  enum class Kind { ended, trigger };
  Kind kind = Kind::ended;
  std::int64_t count = 1;  // number of identical notices since the last ProgramNotice event
};

// A line is about to be written, with its CR LF. This and the other events of the line are for the recorder and the
// metrics.
struct BytesWritten {
  std::string bytes;
  // Number of the exchange, from 1 for each command sent; the exchange's closing question has the same number. 0: a
  // probe outside any exchange.
  std::uint64_t exchange = 0;
  std::string who;  // caller; empty: the line itself
  Lane lane = Lane::question;
  AxisSet completes{};    // axes whose completions may come from now on
  MotionId motion = 0;    // motion to which the line belongs; 0: none
  bool closed = false;    // an !:S follows, since the answer could be mistaken for a completion
  bool question = false;  // the line changes nothing
  AxisSet axes{};         // axes that the line concerns; empty for a question
};

// Received bytes, in the pieces that the driver delivered.
struct BytesReceived {
  std::string bytes;
};

// A time limit passed: for a reply, for a probe in a barrier, or for a command that waited to be sent.
struct TimeLimitPassed {
  enum class Kind { reply, probe, queue };
  Kind kind = Kind::reply;
};
std::string_view name(TimeLimitPassed::Kind kind);  // "reply", "probe", "queue", as in metric labels

// One exchange on the line ended. For metrics and the live view of the line; not a fact with a revision.
struct ExchangeEnded {
  enum class Outcome { ok, ok_d, ng, ng_i, data, timed_out, garbled, link_lost };
  std::string_view command;  // name of the row in the command table
  std::string line, reply;
  Lane lane = Lane::question;
  Outcome outcome = Outcome::ok;
  Duration latency{};          // from the write to the reply's last byte
  bool closed = false;         // the reply became certain only when the !:S after it had been answered
  std::uint64_t exchange = 0;  // as in BytesWritten
  std::string who;             // first caller who asked; empty: the line itself
  Duration waited{};           // from the request to the write
};
std::string_view name(ExchangeEnded::Outcome outcome);  // "ok", "ok_d", "timed_out", ..., as in metric labels

struct BarrierEntered {
  std::string why;
};

// The line's core learned something that changes what it may send, or how it interprets a received number.
struct LineLearned {
  enum class What {
    barrier_passed,   // also the barrier after a connect
    same_controller,  // a suspected restart had not happened
    ready,            // the axes are stationary: their completions may come for a short time longer
    busy,             // the axes are not stationary
  };
  What what = What::barrier_passed;
  AxisSet axes{};  // for ready and busy
};

// An unexpected line: discarded, and counted. The text comes from the device: escape it before showing it.
struct UnexpectedLine {
  std::string text;
};

// A state machine received an event that its table does not have: an internal error of the gateway. The gateway
// disconnects the line and stops everything.
struct IllegalTransition {
  std::string_view machine, state, event;
};

// The positions, mode, excitation or another part of the state are newer; read them with StageController::state().
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
  // Reports whether anybody follows the state as it changes. If nobody does, the controller reads the state less often.
  // Threads as for on_event().
  virtual bool state_followed() const { return true; }
};

}  // namespace axisgate::stage
