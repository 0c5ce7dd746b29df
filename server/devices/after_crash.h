// End of the requests and motions that the previous run left open.
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "server/devices/motion_record.h"
#include "server/events/event_bus.h"
#include "server/journal/journal.h"
#include "server/journal/request_memory.h"

namespace axisgate::server {

// Returns MotionRecord::started_before() of a device; nullopt: any motion may have been started.
using StartedBefore = std::function<std::optional<StartedMotions>(std::string_view device)>;

// Ends open requests and motions. Call it before callers can ask about them. A motion that was not started ends with
// not_sent, and its request's id is free. Motions and changes that may have been started end with outcome_unknown,
// unless their outcome is on record; they never act again. `bus` receives the outcome of each motion as a fact, for
// watchers that resume. `journal` may be null.
void settle_what_was_left(journal::Journal* journal, journal::RequestMemory& requests, EventBus& bus,
                          const StartedBefore& started);

}  // namespace axisgate::server
