// JSON bodies of entries.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "device/stage/axes.h"
#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Replaces each byte that is not valid UTF-8 with U+FFFD: text from a device may contain any bytes.
std::string json_text(const nlohmann::json& json);

nlohmann::json axes_of(stage::AxisSet axes);
// Returns the axes, or "device" for a whole device.
nlohmann::json scope_of(use::Scope scope);

// A Noted is an entry that has no device and no time yet.
struct Noted {
  EntryKind kind = EntryKind::daemon_started;
  nlohmann::json body{};
  std::string who{};
  std::uint64_t motion = 0;
};
Entry entry_of(Noted noted, std::string device, TimePoint now);

}  // namespace axisgate::server::journal
