// Stream of the facts of all devices, from a revision on.
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

// An EventRange selects the events that a reader wants.
struct EventRange {
  std::string device{};                 // "devices/{d}"; empty: all devices
  std::string run{};                    // daemon's run that published the event before `from`; empty: not checked
  std::optional<std::uint64_t> from{};  // first revision; 0: the oldest kept one; nullopt: new events only
};

using Event = std::shared_ptr<const server::FactRecord>;  // never null

// Thread safe.
class Events {
 public:
  // The referenced objects must outlive this one.
  Events(server::Gateway& gateway, const Admission& admission, Streams& streams)
      : gateway_(gateway), admission_(admission), streams_(streams) {}

  // Streams each event once and in order. Ends with compacted, and the revision to resume from, if the next event is no
  // longer kept; immediately if `run` and `from` do not match.
  Opened<Event> watch(const Call& call, const EventRange& range) const;

 private:
  server::Gateway& gateway_;
  const Admission& admission_;
  Streams& streams_;
};

}  // namespace axisgate::api
