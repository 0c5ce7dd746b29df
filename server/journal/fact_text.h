// Text form of a fact, which outlives the daemon.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/events/event_bus.h"

namespace axisgate::server::journal {

// Writes the fact and its clock. The text contains names and messages, so it does not belong in the chain.
std::string text_of(const FactRecord& record);

// Reads the fact and its clock alone. Returns nullopt if the text is not a fact.
std::optional<FactRecord> fact_in(std::string_view text);

}  // namespace axisgate::server::journal
