// The controller's line: one exchange in flight, completions distinguished from replies, and the barrier after doubt.
// Its phases and their transitions are in link.h.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/core/lane_queue.h"
#include "device/core/line_framer.h"
#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/core/task.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/command/codec.h"
#include "device/shrc203/command/reply.h"
#include "device/shrc203/line/barrier.h"
#include "device/shrc203/line/completions.h"
#include "device/shrc203/line/continuity.h"
#include "device/shrc203/line/flood.h"
#include "device/shrc203/line/line_timing.h"
#include "device/shrc203/line/link.h"
#include "device/shrc203/line/reservations.h"
#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

struct ExchangeRequest {
  Command command;
  Lane lane = Lane::question;
  std::string caller;
  std::string identity{};   // of a caller's own line: whose turn it is, with a share of the lane; empty: the caller's
  TimePoint not_after{};    // not written later than this
  MotionId motion = 0;      // the motion it belongs to
  std::uint64_t lease = 0;  // of one that belongs to none: the lease of its request,
  AxisSet uses;             // and the axes that it needs the right to
  bool tidies = false;      // it only undoes what the motion did: no right is needed for that
  AxisSet completes;        // the axes whose numbers may come once it is written
  bool handshake = false;   // may be sent before open()
  bool closed = false;      // an !:S follows a number that could be a completion, so that all of them are in
};

struct ExchangeResult {
  bool written = false;              // false: the controller has certainly not seen it
  std::optional<Reply> reply{};      // set when an answer was matched
  std::optional<Problem> problem{};  // why there is no answer that can be believed; also set for NG_I
  // Of one in doubt: whether ?:CMD has shown that the controller received it; nothing where it has shown neither.
  std::optional<bool> received{};

  // Of a closed exchange whose answer could not be distinguished from completions: all numbers. `reply` is the first.
  std::vector<int> candidates{};

  bool accepted() const { return reply && reply->accepted() && !problem; }
  bool refused() const { return reply && reply->kind == Reply::Kind::ng; }
  // Written, and nobody knows what the controller made of it.
  bool in_doubt() const { return written && problem.has_value(); }
};

// A question that waits until no completion could be taken for its answer.
struct HeldQuestion {
  std::string line, caller;
  TimePoint since{};
};

class LineListener {
 public:
  virtual ~LineListener() = default;
  virtual void line_opened(TimePoint now) = 0;
  // Returns the stops to write now, before any probe: the port was opened (`heard` is empty), or a line other than an
  // axis number was received during a barrier. Their answers are not waited for.
  virtual std::vector<ExchangeRequest> stops_to_write(std::string_view heard, TimePoint now) = 0;
  // Reports whether a stop is open, so that a closed port is opened again soon.
  virtual bool stop_is_open() const = 0;
  // The identity was received and the line fell silent: the handshake may run.
  // `line_before`: what the controller had been sent before, where Line::ask_line_before() was called.
  virtual void line_connected(const Identity& identity, const std::optional<std::string>& line_before,
                              TimePoint now) = 0;
  virtual void line_trusted(TimePoint now) = 0;  // open() was called; what waits is sent next
  virtual void line_lost(const std::string& why, TimePoint now) = 0;
  virtual void barrier_entered(const std::string& why, TimePoint now) = 0;
  virtual void barrier_passed(const Identity& identity, TimePoint now) = 0;
  // Nothing but a stop and what belongs to the handshake is sent before confirm_no_restart() or disconnect().
  virtual void restart_suspected(TimePoint now) = 0;
  virtual void same_controller(TimePoint now) = 0;  // confirm_no_restart() was called
  // `doubtful`: not expected now, or seen in a barrier.
  virtual void completion_seen(int axis, bool doubtful, TimePoint now) = 0;
  virtual void line_event(const Event& event, TimePoint now) = 0;
  // Asked of what belongs to a motion, right before it is written; with a problem it never is.
  virtual std::optional<Problem> may_write(const ExchangeRequest& request, TimePoint now) = 0;
};

class Line {
 public:
  Line(const Profile& profile, ByteLink& link, Executor& executor, LineListener& listener);

  // From now on a connect begins with ?:CMD, until a controller has answered.
  void ask_line_before() { asks_line_before_ = true; }
  void link_up(TimePoint now);
  void link_down(TimePoint now, std::string_view why);
  void receive(std::string_view bytes, TimePoint now);
  void advance(TimePoint now);
  std::optional<TimePoint> next_deadline(TimePoint now) const;

  // A closed port is opened now instead of after its pause: a stop waits.
  void open_at_once(TimePoint now);

  // co_await yields an ExchangeResult, always. Identical questions that wait in one lane share an exchange.
  OneShot<ExchangeResult> exchange(ExchangeRequest request, TimePoint now);

  // Ends all waiting exchanges for which chosen(request) holds, unwritten, with `problem`.
  void withdraw(const std::function<bool(const ExchangeRequest&)>& chosen, const Problem& problem);

  // The question that has waited longest of those which motions hold back; nothing where none does. Before the
  // handshake has passed none counts.
  std::optional<HeldQuestion> held_question() const;

  // Nothing but a stop is written from now on: what waits ends unwritten with `problem`, and so does what comes.
  void seal(const Problem& problem);
  // An exchange is in flight, or its answer is held back by the barrier.
  bool exchanging() const { return in_flight_ || doubted_waiting_; }
  // The motion whose start is in flight; 0 for none.
  MotionId starting() const;

  void open(AxisSet controllable, TimePoint now);          // the handshake has passed
  void disconnect(const std::string& why, TimePoint now);  // close, and open again after the backoff
  void confirm_no_restart(TimePoint now);                  // the suspected restart was none
  bool restart_only_possible() const { return continuity_.only_late(); }

  // A reading showed these axes as stationary, or as moving.
  void ready(AxisSet axes, TimePoint now);
  void busy(AxisSet axes, TimePoint now);

  // A path's next refill will be requested at `due`. Until then nothing begins in the lanes below that may not have
  // ended by then. From then on nothing begins there until the refill is written or kRefillReservedAfterDue has passed.
  void keep_free(MotionId path, TimePoint due, TimePoint now);
  void release(MotionId path, TimePoint now);
  const LineTiming& timing() const { return timing_; }

  const Link& state() const { return state_; }
  Completions& completions() { return completions_; }
  const Completions& completions() const { return completions_; }
  std::size_t queued(Lane lane) const { return queue_.size(lane); }
  // Answers to abandoned probes that may still come.
  int outstanding() const { return outstanding_.echoes + outstanding_.identities; }

 private:
  struct Waiting {
    ExchangeRequest request;
    std::vector<OneShot<ExchangeResult>> answers;
    TimePoint asked;
  };
  using WaitingPtr = std::shared_ptr<Waiting>;
  struct InFlight {
    WaitingPtr waiting;
    TimePoint written, limit;
    std::uint64_t exchange = 0;
    std::vector<int> numbers;  // not empty: an !:S has been written behind it
    bool echo_first = false;   // a ?:CMD has been written before it and not been answered
  };

  static constexpr auto kLineBefore = commands::Question::previous_command, kSettling = commands::Question::ready;

  bool can_send() const { return state_.port_open() && !in_flight_ && !barrier_; }
  // False, and the line is disconnected, for an event that the phase does not permit.
  bool change(LinkEvent event, TimePoint now);
  void pump(TimePoint now);
  void send(WaitingPtr waiting, TimePoint now);
  void shut(const std::string& why, TimePoint now);
  bool shut_if_flooded(TimePoint now);
  void send_stops_now(TimePoint now);
  bool write_waiting_stops();  // whether there were any
  bool write_open_stops(std::string_view heard);
  Duration pause_before_reopening();
  // `cause` is null for what the line asks for itself.
  void write_line(std::string_view line, std::uint64_t exchange = 0, const ExchangeRequest* cause = nullptr);
  ExchangeEnded ended(const InFlight& exchange, const ExchangeResult& result, ExchangeEnded::Outcome outcome,
                      TimePoint now) const;
  bool asks_first(TimePoint now) const;
  bool asks_now(const std::function<bool(const WaitingPtr&)>& may_go, bool settle) const;
  bool may_send(const ExchangeRequest& request) const;
  WaitingPtr take_next(const std::function<bool(const WaitingPtr&)>& may_go, TimePoint now);
  bool leaves_refills_alone(const ExchangeRequest& request, TimePoint now) const;
  bool may_settle(TimePoint now) const;
  AxisSet ambiguous(const ExchangeRequest& request, AxisSet axes) const;
  AxisSet conflicts(const ExchangeRequest& request) const;
  std::optional<TimePoint> conflicts_settle_from() const;
  void expire(TimePoint now);
  Problem why_expired(const ExchangeRequest& request) const;
  bool line_is_coming(TimePoint now);
  bool drop_unended(TimePoint now);

  void on_line(const LineFramer::Line& line, TimePoint now);
  void doubt_answer(std::string_view text, TimePoint now);
  bool on_axis_number(std::string_view text, TimePoint now);
  void on_number(int number, TimePoint now);
  void on_line_while_closing(std::string_view text, TimePoint now);
  void close(TimePoint now);
  void on_reply(Reply reply, TimePoint now);
  AxisSet busy_in(const ExchangeRequest& request, const Reply& reply) const;
  void finish(ExchangeResult result, ExchangeEnded::Outcome outcome, TimePoint now);
  void enter_barrier(ExchangeResult doubted, ExchangeEnded::Outcome outcome, const std::string& why, TimePoint now);
  void barrier_moved(TimePoint now);
  void in_barrier(std::string_view text, TimePoint now);
  void on_last_command(std::string_view line_before, TimePoint now);
  void look_at_continuity(TimePoint now);
  void unexpected(std::string_view text, TimePoint now);
  void learned(LineLearned::What what, AxisSet axes = {});
  bool is_known(const Identity& identity) const;
  Barrier::Limits barrier_limits() const;
  Barrier::Limits connect_limits();
  std::unique_ptr<Barrier> make_barrier(std::string line_in_doubt, Barrier::Limits limits);

  const Profile& profile_;
  ByteLink& link_;
  Executor& executor_;
  LineListener& listener_;
  Link state_;
  Duration backoff_;
  LineFramer framer_;
  LineTiming timing_;
  Flood flood_;
  Reservations reservations_;
  Completions completions_;
  Continuity continuity_;
  TimePoint now_{};  // of the call from outside
  AxisSet controllable_;
  bool asks_line_before_ = false;
  bool connected_before_ = false;
  std::string answering_;  // the serial number of the connect
  std::string trusted_;    // that of the newest connect whose handshake has passed; empty before the first
  LaneQueue<WaitingPtr> queue_;
  std::uint64_t exchanges_ = 0;
  std::optional<InFlight> in_flight_;
  bool maybe_in_two_ = false;                    // the newest line was answered so that another answer to it may follow
  std::optional<TimePoint> after_refused_stop_;  // it was a stop: nothing is sent before
  std::optional<TimePoint> partial_since_;       // an incomplete line has been coming in since then
  std::unique_ptr<Barrier> barrier_;
  std::optional<ExchangeResult> doubted_;  // the result held back until the barrier has passed
  WaitingPtr doubted_waiting_;
  OutstandingAnswers outstanding_;
  std::optional<Problem> sealed_;
};

}  // namespace axisgate::shrc203
