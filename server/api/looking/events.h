// The facts of all devices from a revision on.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/api/request/admission.h"
#include "server/api/request/call.h"
#include "server/api/request/subscription.h"
#include "server/events/event_bus.h"
#include "server/gateway.h"

namespace axisgate::api {

// Which events a reader wants.
struct EventRange {
  std::string device{};                 // "devices/{d}"; empty: of all
  std::string run{};                    // of which daemon's run the event before `from` is; empty: not checked
  std::optional<std::uint64_t> from{};  // 0: from the oldest that is kept; nothing: from now on
};

using Event = std::shared_ptr<const server::FactRecord>;  // never null

// Thread safe.
class Events {
 public:
  // All outlive this.
  Events(server::Gateway& gateway, const Admission& admission, Streams& streams)
      : gateway_(gateway), admission_(admission), streams_(streams) {}

  // Each once and in order. Ends with compacted, and where to resume, when the next one is not kept any more, at once
  // where run and revision do not belong together.
  Opened<Event> watch(const Call& call, const EventRange& range) const;

 private:
  server::Gateway& gateway_;
  const Admission& admission_;
  Streams& streams_;
};

}  // namespace axisgate::api
