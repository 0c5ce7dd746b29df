// Lines that wait to be sent, by lane, and the questions among them whose replies could be taken for completions.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "device/core/lane_queue.h"
#include "device/core/problem.h"
#include "device/core/task.h"
#include "device/core/time.h"
#include "device/shot/line/completions.h"
#include "device/shot/line/exchange_request.h"
#include "device/shot/line/line_listener.h"
#include "device/shot/line/link.h"
#include "device/shot/line/reservations.h"

namespace axisgate::shot {

class WaitingLines {
 public:
  using Chosen = std::function<bool(const Waiting&)>;

  // `controllable`: the axes of the present connection. The referenced objects must outlive this one.
  WaitingLines(LineListener& listener, const Link& link, const Completions& completions,
               const Reservations& reservations, const AxisSet& controllable)
      : listener_(listener),
        link_(link),
        completions_(completions),
        reservations_(reservations),
        controllable_(controllable) {}

  // Queues the line, or lets it share the exchange of an identical question. `answer` receives a problem if the lane is
  // full, the port closed or the queue sealed. Returns whether the queue has a line more.
  bool add(ExchangeRequest request, OneShot<ExchangeResult> answer, TimePoint now);
  // Takes the next line for which `may_go` is true; null if there is none. Lines that lost their right while they
  // waited are refused.
  WaitingPtr take(const Chosen& may_go, TimePoint now);
  // Takes all waiting stops.
  void take_stops(const std::function<void(const WaitingPtr&)>& taken);
  // Ends, unwritten and with `problem`, all lines for which `chosen` is true.
  void withdraw(const std::function<bool(const ExchangeRequest&)>& chosen, const Problem& problem);
  // Ends the lines whose time has passed.
  void expire(TimePoint now);
  // From now on only stops and lines of the handshake are queued; the others end with `problem`.
  void seal(const Problem& problem);

  bool sealed() const { return sealed_.has_value(); }
  std::size_t size(Lane lane) const { return queue_.size(lane); }
  bool stops_turn() const { return queue_.stops_turn(); }
  void for_each(const std::function<void(const Waiting&)>& look) const;
  // Returns the time after which the next line expires; nullopt if no line waits.
  std::optional<TimePoint> next_expiry() const;

  // Returns the axes whose completions could now be taken for the reply.
  AxisSet conflicts(const ExchangeRequest& request) const { return ambiguous(request, completions_.possible()); }
  // Returns the time from which !: may be sent on behalf of a question that waits until all completions have arrived.
  std::optional<TimePoint> conflicts_settle_from() const;
  // Returns the longest waiting question among those that completions may hold back. nullopt if there is none, before
  // the handshake has passed, and after seal(). Counts a question until it is written, even if it may be sent now: if
  // other lines go first, the next motion would hold it back again.
  std::optional<HeldQuestion> held_question() const;

 private:
  AxisSet ambiguous(const ExchangeRequest& request, AxisSet axes) const;
  WaitingPtr same_question(const ExchangeRequest& request) const;
  Problem why_expired(const ExchangeRequest& request) const;

  LineListener& listener_;
  const Link& link_;
  const Completions& completions_;
  const Reservations& reservations_;
  const AxisSet& controllable_;
  LaneQueue<WaitingPtr> queue_;
  std::optional<Problem> sealed_;
};

}  // namespace axisgate::shot
