// State machines as tables: a transition that is not in the table cannot happen.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace axisgate {

template <class State, class Event>
struct Transition {
  State from;
  Event event;
  State to;
};

// Returns the state after the event; nullopt if the table has no such transition.
template <class State, class Event, std::size_t Count>
constexpr std::optional<State> next_in(const std::array<Transition<State, Event>, Count>& table, State state,
                                       Event event) {
  for (const auto& row : table) {
    if (row.from == state && row.event == event) return row.to;
  }
  return std::nullopt;
}

}  // namespace axisgate
