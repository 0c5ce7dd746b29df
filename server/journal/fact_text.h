// A fact as text, so that it outlives the daemon.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/events/event_bus.h"

namespace axisgate::server::journal {

// Its fact and its clock. With names and messages, so that it is not for the chain.
std::string text_of(const FactRecord& record);

// With fact and clock alone. Nothing, where the text is no fact.
std::optional<FactRecord> fact_in(std::string_view text);

}  // namespace axisgate::server::journal
