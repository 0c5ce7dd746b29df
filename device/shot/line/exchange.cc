#include "device/shot/line/exchange.h"

#include <array>
#include <utility>

#include "device/core/transitions.h"

namespace axisgate::shot {
namespace {

// README.md has this table for people.
constexpr auto kExchangeTransitions = std::to_array<Transition<ExchangePhase, ExchangeEvent>>({
    {ExchangePhase::idle, ExchangeEvent::written, ExchangePhase::in_flight},
    {ExchangePhase::idle, ExchangeEvent::written_after_question, ExchangePhase::after_question},
    {ExchangePhase::idle, ExchangeEvent::doubted, ExchangePhase::in_doubt},
    {ExchangePhase::idle, ExchangeEvent::line_closed, ExchangePhase::idle},
    {ExchangePhase::after_question, ExchangeEvent::question_answered, ExchangePhase::in_flight},
    {ExchangePhase::after_question, ExchangeEvent::ended, ExchangePhase::idle},
    {ExchangePhase::after_question, ExchangeEvent::doubted, ExchangePhase::in_doubt},
    {ExchangePhase::in_flight, ExchangeEvent::number_received, ExchangePhase::closing},
    {ExchangePhase::in_flight, ExchangeEvent::ended, ExchangePhase::idle},
    {ExchangePhase::in_flight, ExchangeEvent::doubted, ExchangePhase::in_doubt},
    {ExchangePhase::closing, ExchangeEvent::number_received, ExchangePhase::closing},
    {ExchangePhase::closing, ExchangeEvent::ended, ExchangePhase::idle},
    {ExchangePhase::closing, ExchangeEvent::doubted, ExchangePhase::in_doubt},
    {ExchangePhase::in_doubt, ExchangeEvent::resolved, ExchangePhase::idle},
    {ExchangePhase::in_doubt, ExchangeEvent::line_closed, ExchangePhase::idle},
});

constexpr std::array<std::string_view, kExchangePhases> kExchangePhaseNames = {"idle", "after_question", "in_flight",
                                                                               "closing", "in_doubt"};
constexpr std::array<std::string_view, kExchangeEvents> kExchangeEventNames = {
    "written",    "written_after_question", "question_answered", "number_received", "ended", "doubted", "resolved",
    "line_closed"};

}  // namespace

std::string_view name(ExchangePhase phase) { return kExchangePhaseNames.at(static_cast<std::size_t>(phase)); }
std::string_view name(ExchangeEvent event) { return kExchangeEventNames.at(static_cast<std::size_t>(event)); }

std::optional<ExchangePhase> next(ExchangePhase phase, ExchangeEvent event) {
  return next_in(kExchangeTransitions, phase, event);
}

bool Exchange::happened(ExchangeEvent event) {
  const auto to = next(phase_, event);
  if (to) {
    phase_ = *to;
  } else {
    violations_.illegal("exchange", name(phase_), name(event));
  }
  return to.has_value();
}

bool Exchange::awaits_result() const {
  const auto* doubt = std::get_if<InDoubt>(&held_);
  return in_flight() != nullptr || (doubt != nullptr && doubt->doubted);
}

void Exchange::written(InFlight line, bool after_question) {
  if (happened(after_question ? ExchangeEvent::written_after_question : ExchangeEvent::written))
    held_ = std::move(line);
}

void Exchange::question_answered() { happened(ExchangeEvent::question_answered); }

void Exchange::number_received(int number) {
  if (happened(ExchangeEvent::number_received)) in_flight()->numbers.push_back(number);
}

std::optional<InFlight> Exchange::ended() {
  if (!happened(ExchangeEvent::ended)) return std::nullopt;
  return std::get<InFlight>(std::exchange(held_, {}));
}

void Exchange::doubted(std::unique_ptr<Barrier> barrier, std::optional<Doubted> doubted) {
  if (happened(ExchangeEvent::doubted)) held_ = InDoubt{std::move(barrier), std::move(doubted)};
}

std::optional<Doubted> Exchange::leave_barrier(ExchangeEvent event) {
  if (!happened(event)) return std::nullopt;
  auto before = std::exchange(held_, {});
  auto* doubt = std::get_if<InDoubt>(&before);
  return doubt == nullptr ? std::nullopt : std::move(doubt->doubted);
}

}  // namespace axisgate::shot
