// Whether an entry is true, in two halves that share no code: the gateway's table, and the simulator.
#pragma once

#include <optional>
#include <string>

#include "tests/conformance/transcript.h"

namespace axisgate::shrc203::conformance {

using Complaint = std::optional<std::string>;  // nothing where the entry holds

Complaint check_by_table(const Entry& entry);

// Nothing for an offline entry, whose state the simulator cannot be brought into.
Complaint check_by_simulator(const Entry& entry);

Complaint check(const Entry& entry);

}  // namespace axisgate::shrc203::conformance
