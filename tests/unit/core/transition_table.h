// Check of a state machine against its table in device/shrc203/README.md: one row for each state, one cell for each
// event.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::testing_tables {

// Rows by the state's name; "-" marks an impossible event.
using Table = std::map<std::string, std::vector<std::string>>;

// Checks every pair of state and event, and returns the number of impossible pairs.
template <class State, class Event, class Next>
int illegal_pairs(const Table& table, std::size_t states, const std::vector<std::string>& events, Next next) {
  int illegal = 0;
  EXPECT_EQ(table.size(), states);
  for (std::size_t state = 0; state < states; ++state) {
    const auto from = static_cast<State>(state);
    const auto row = table.find(std::string(name(from)));
    if (row == table.end() || row->second.size() != events.size()) {
      ADD_FAILURE() << "the table has no whole row for " << name(from);
      continue;
    }
    for (std::size_t event = 0; event < events.size(); ++event) {
      EXPECT_EQ(name(static_cast<Event>(event)), events[event]);
      const auto to = next(from, static_cast<Event>(event));
      EXPECT_EQ(to ? std::string(name(*to)) : "-", row->second[event]) << name(from) << ", " << events[event];
      illegal += to ? 0 : 1;
    }
  }
  return illegal;
}

}  // namespace axisgate::testing_tables
