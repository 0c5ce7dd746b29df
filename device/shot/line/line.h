// Line to the controller: one exchange in flight, completions distinguished from replies, and the barrier after doubt.
// link.h and exchange.h have the states; sending.h, receiving.h and recovery.h the parts, which line.cc joins.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/core/task.h"
#include "device/core/violations.h"
#include "device/shot/command/model.h"
#include "device/shot/line/completions.h"
#include "device/shot/line/continuity.h"
#include "device/shot/line/exchange.h"
#include "device/shot/line/exchange_request.h"
#include "device/shot/line/flood.h"
#include "device/shot/line/incoming.h"
#include "device/shot/line/line_listener.h"
#include "device/shot/line/line_timing.h"
#include "device/shot/line/link.h"
#include "device/shot/line/port.h"
#include "device/shot/line/receiving.h"
#include "device/shot/line/recovery.h"
#include "device/shot/line/reservations.h"
#include "device/shot/line/results.h"
#include "device/shot/line/second_reply.h"
#include "device/shot/line/sending.h"
#include "device/shot/line/waiting_lines.h"
#include "device/shot/line/wire.h"
#include "device/shot/profile.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

class Line : private Port, private Violations {
 public:
  // The referenced objects must outlive the line.
  Line(const Model& model, const Profile& profile, ByteLink& link, Executor& executor, LineListener& listener);

  // Makes each connect begin with ?:CMD until a controller has answered.
  void ask_line_before() { recovery_.ask_line_before(); }
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
  void withdraw(const std::function<bool(const ExchangeRequest&)>& chosen, const Problem& problem) {
    waiting_.withdraw(chosen, problem);
  }

  // See WaitingLines::held_question().
  std::optional<HeldQuestion> held_question() const { return waiting_.held_question(); }

  // Restricts the line to stops. Waiting and later lines end with `problem`, unwritten; lines of the handshake stay
  // queued.
  void seal(const Problem& problem) { waiting_.seal(problem); }
  // Reports whether an exchange is in flight, or the barrier holds back its result.
  bool exchanging() const { return exchange_.awaits_result(); }
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

  const Link& state() const { return link_state_; }
  Completions& completions() { return completions_; }
  const Completions& completions() const { return completions_; }
  std::size_t queued(Lane lane) const { return waiting_.size(lane); }
  // Returns the number of replies to abandoned probes that may still arrive.
  int outstanding() const { return recovery_.outstanding_count(); }

 private:
  bool change(LinkEvent event, TimePoint now) override;
  void close(LinkEvent event, const std::string& why, TimePoint now) override;
  void illegal(std::string_view machine, std::string_view state, std::string_view event) override;
  Duration pause_before_reopening();

  const Model& model_;
  ByteLink& link_;
  Executor& executor_;
  LineListener& listener_;
  Link link_state_;
  Duration backoff_;
  TimePoint now_{};       // time of the newest call from outside
  AxisSet controllable_;  // axes of the present connection
  Incoming incoming_;
  LineTiming timing_;
  Flood flood_;
  Completions completions_;
  Continuity continuity_;
  Reservations reservations_;
  SecondReply second_reply_;
  Exchange exchange_{*this};
  WaitingLines waiting_{listener_, link_state_, completions_, reservations_, controllable_};
  Wire wire_{link_, listener_, timing_, continuity_, controllable_};
  Results results_{model_, listener_, exchange_, completions_, timing_, flood_, controllable_};
  Recovery recovery_;
  Receiving receiving_{model_,       *this,       listener_, link_state_,   controllable_, incoming_, flood_,
                       completions_, continuity_, exchange_, second_reply_, wire_,         results_,  recovery_};
  Sending sending_;
};

}  // namespace axisgate::shot
