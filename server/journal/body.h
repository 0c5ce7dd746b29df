// How entries say what they say: JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "device/stage/axes.h"
#include "server/journal/entry.h"

namespace axisgate::server::journal {

// What came from a device may be no UTF-8: each such byte becomes U+FFFD.
std::string json_text(const nlohmann::json& json);

nlohmann::json axes_of(stage::AxisSet axes);

// An entry before it has its device and time.
struct Noted {
  EntryKind kind = EntryKind::daemon_started;
  nlohmann::json body{};
  std::string who{};
  std::uint64_t motion = 0;
};
Entry entry_of(Noted noted, std::string device, TimePoint now);

}  // namespace axisgate::server::journal
