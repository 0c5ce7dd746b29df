// What became of the requests and motions that a run before this one left without an end.
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "server/devices/motion_record.h"
#include "server/events/event_bus.h"
#include "server/journal/journal.h"
#include "server/journal/request_memory.h"

namespace axisgate::server {

// Of a device, MotionRecord::started_before(). Nothing: any motion may have been started.
using StartedBefore = std::function<std::optional<StartedMotions>(std::string_view device)>;

// Before anybody asks. A motion that was not started ends with not_sent, and its request's id is free. What may have
// been started or changed ends with outcome_unknown, unless its outcome is on record; it never acts again. `bus` gets
// the outcome of each motion as a fact, for watchers that resume. `journal` may be null.
void settle_what_was_left(journal::Journal* journal, journal::RequestMemory& requests, EventBus& bus,
                          const StartedBefore& started);

}  // namespace axisgate::server
