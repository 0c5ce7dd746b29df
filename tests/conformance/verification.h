// Checks of a transcript's entry, by two methods that share no code: the gateway's command table, and the simulator.
#pragma once

#include <optional>
#include <string>

#include "tests/conformance/transcript.h"

namespace axisgate::shrc203::conformance {

using Complaint = std::optional<std::string>;  // nullopt if the entry is correct

Complaint check_by_table(const Entry& entry);

// Returns nullopt for an offline entry, because the simulator cannot reach its state.
Complaint check_by_simulator(const Entry& entry);

Complaint check(const Entry& entry);

}  // namespace axisgate::shrc203::conformance
