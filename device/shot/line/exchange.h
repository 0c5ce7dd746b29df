// State machine of the exchange in flight: one enum, changed in one place by the table of README.md. What belongs to a
// phase exists in that phase only.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "device/core/time.h"
#include "device/core/violations.h"
#include "device/shot/line/barrier.h"
#include "device/shot/line/exchange_request.h"

namespace axisgate::shot {

// Sent after a number that may be the reply or a completion.
inline constexpr auto kClosing = LineQuestion::each_ready;

enum class ExchangePhase {
  idle,            // no line awaits a reply
  after_question,  // a ?:CMD and a line were written, and the ?:CMD is not answered yet
  in_flight,       // a line awaits its reply
  closing,         // a number that may be the reply was received, and an !:S was written after it
  in_doubt,        // a barrier is in progress: after a connect, or because a reply cannot be trusted
};
inline constexpr std::size_t kExchangePhases = 5;

enum class ExchangeEvent {
  written,
  written_after_question,
  question_answered,
  number_received,
  ended,        // with a reply, or because the port was closed
  doubted,      // a barrier begins
  resolved,     // the barrier has passed
  line_closed,  // the port was closed
};
inline constexpr std::size_t kExchangeEvents = 8;

std::string_view name(ExchangePhase phase);  // "idle", as in README.md
std::string_view name(ExchangeEvent event);

// Returns the phase after the event; nullopt if the table has no such transition.
std::optional<ExchangePhase> next(ExchangePhase phase, ExchangeEvent event);

// A line that awaits its reply.
struct InFlight {
  WaitingPtr waiting;
  TimePoint written, limit;
  std::uint64_t exchange = 0;
  std::vector<int> numbers{};  // received in phase closing

  const ExchangeRequest& request() const { return waiting->request; }
};

// A result that waits until the barrier has passed.
struct Doubted {
  WaitingPtr waiting;
  ExchangeResult result;
};

class Exchange {
 public:
  // `violations` must outlive this object. An event that the present phase does not permit is reported there, and
  // changes nothing.
  explicit Exchange(Violations& violations) : violations_(violations) {}

  ExchangePhase phase() const { return phase_; }
  bool idle() const { return phase_ == ExchangePhase::idle; }
  bool closing() const { return phase_ == ExchangePhase::closing; }
  // Null while no line awaits a reply.
  InFlight* in_flight() { return std::get_if<InFlight>(&held_); }
  const InFlight* in_flight() const { return std::get_if<InFlight>(&held_); }
  // Null unless the phase is in_doubt.
  Barrier* barrier() { return in_doubt() ? in_doubt()->barrier.get() : nullptr; }
  const Barrier* barrier() const { return const_cast<Exchange*>(this)->barrier(); }
  // Reports whether an exchange is in flight, or a barrier holds back its result.
  bool awaits_result() const;

  void written(InFlight line, bool after_question);
  void question_answered();
  void number_received(int number);
  // Returns the exchange that has ended; nullopt if none was in flight.
  std::optional<InFlight> ended();
  void doubted(std::unique_ptr<Barrier> barrier, std::optional<Doubted> doubted);
  // The barrier has passed, or the port was closed. Returns the result that waited for it, if any.
  std::optional<Doubted> resolved() { return leave_barrier(ExchangeEvent::resolved); }
  std::optional<Doubted> line_closed() { return leave_barrier(ExchangeEvent::line_closed); }

 private:
  struct InDoubt {
    std::unique_ptr<Barrier> barrier;
    std::optional<Doubted> doubted;
  };

  InDoubt* in_doubt() { return std::get_if<InDoubt>(&held_); }
  bool happened(ExchangeEvent event);
  std::optional<Doubted> leave_barrier(ExchangeEvent event);

  Violations& violations_;
  ExchangePhase phase_ = ExchangePhase::idle;
  std::variant<std::monostate, InFlight, InDoubt> held_;
};

}  // namespace axisgate::shot
