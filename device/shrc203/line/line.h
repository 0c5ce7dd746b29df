// Line to the controller: one exchange in flight, completions distinguished from replies, and the barrier after doubt.
// The phases and their transitions are in link.h.
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
#include "device/shrc203/line/exchange_request.h"
#include "device/shrc203/line/flood.h"
#include "device/shrc203/line/line_listener.h"
#include "device/shrc203/line/line_timing.h"
#include "device/shrc203/line/link.h"
#include "device/shrc203/line/reservations.h"
#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

class Line {
 public:
  Line(const Profile& profile, ByteLink& link, Executor& executor, LineListener& listener);

  // Makes each connect begin with ?:CMD until a controller has answered.
  void ask_line_before() { asks_line_before_ = true; }
  void link_up(TimePoint now);
  void link_down(TimePoint now, std::string_view why);
  void receive(std::string_view bytes, TimePoint now);
  void advance(TimePoint now);
  std::optional<TimePoint> next_deadline(TimePoint now) const;

  // Opens a closed port now instead of after its pause, because a stop waits.
  void open_at_once(TimePoint now);

  // Queues the line. co_await always yields an ExchangeResult. Identical questions that wait in one lane share an
  // exchange.
  OneShot<ExchangeResult> exchange(ExchangeRequest request, TimePoint now);

  // Ends, unwritten and with `problem`, all waiting exchanges for which chosen(request) is true.
  void withdraw(const std::function<bool(const ExchangeRequest&)>& chosen, const Problem& problem);

  // Returns the longest waiting question among those that completions may hold back. nullopt if there is none, before
  // the handshake has passed, and after seal().
  std::optional<HeldQuestion> held_question() const;

  // Restricts the line to stops. Waiting and later lines end with `problem`, unwritten; lines of the handshake stay
  // queued.
  void seal(const Problem& problem);
  // Reports whether an exchange is in flight, or the barrier holds back its result.
  bool exchanging() const { return in_flight_ || doubted_waiting_; }
  // Returns the motion whose start is in flight; 0 for none.
  MotionId starting() const;

  void open(AxisSet controllable, TimePoint now);          // the handshake has passed
  void disconnect(const std::string& why, TimePoint now);  // closes the port, and opens it again after the backoff
  void confirm_no_restart(TimePoint now);                  // the suspected restart did not happen
  bool restart_only_possible() const { return continuity_.only_late(); }

  // Called when a reading showed these axes as stationary, or as moving.
  void ready(AxisSet axes, TimePoint now);
  void busy(AxisSet axes, TimePoint now);

  // Keeps the line free for the path's next refill, which will be requested at `due`. Before `due`, lower lanes begin
  // only exchanges that end by then. After `due`, they begin nothing until the refill is written or
  // kRefillReservedAfterDue has passed.
  void keep_free(MotionId path, TimePoint due, TimePoint now);
  void release(MotionId path, TimePoint now);
  const LineTiming& timing() const { return timing_; }

  const Link& state() const { return state_; }
  Completions& completions() { return completions_; }
  const Completions& completions() const { return completions_; }
  std::size_t queued(Lane lane) const { return queue_.size(lane); }
  // Returns the number of replies to abandoned probes that may still arrive.
  int outstanding() const { return outstanding_.echoes + outstanding_.identities; }

 private:
  struct InFlight {
    WaitingPtr waiting;
    TimePoint written, limit;
    std::uint64_t exchange = 0;
    std::vector<int> numbers;  // if not empty, an !:S has been written after the line
    bool echo_first = false;   // a ?:CMD has been written before the line and is not answered yet
  };

  static constexpr auto kLineBefore = commands::Question::previous_command, kSettling = commands::Question::ready;

  bool can_send() const { return state_.port_open() && !in_flight_ && !barrier_; }
  // Applies the event. Returns false and disconnects if the phase does not permit it.
  bool change(LinkEvent event, TimePoint now);
  void pump(TimePoint now);
  void send(WaitingPtr waiting, TimePoint now);
  void shut(const std::string& why, TimePoint now);
  bool shut_if_flooded(TimePoint now);
  void send_stops_now(TimePoint now);
  bool write_waiting_stops();  // returns whether there were any
  bool write_open_stops(std::string_view heard);
  Duration pause_before_reopening();
  // `cause` is null if no request caused the line.
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
  TimePoint now_{};  // time of the newest outside call
  AxisSet controllable_;
  bool asks_line_before_ = false;
  bool connected_before_ = false;
  std::string answering_;  // serial number read in the present connect
  std::string trusted_;    // serial number of the newest passed handshake; empty before the first
  LaneQueue<WaitingPtr> queue_;
  std::uint64_t exchanges_ = 0;
  std::optional<InFlight> in_flight_;
  bool second_reply_possible_ = false;  // the newest line may have been cut in two, so a second reply to it may follow
  std::optional<TimePoint> after_refused_stop_;  // nothing is sent before this time after a refused stop
  std::optional<TimePoint> partial_since_;       // time at which the present incomplete line was noticed
  std::unique_ptr<Barrier> barrier_;
  std::optional<ExchangeResult> doubted_;  // result that waits until the barrier has passed
  WaitingPtr doubted_waiting_;
  OutstandingAnswers outstanding_;
  std::optional<Problem> sealed_;
};

}  // namespace axisgate::shrc203
