#include "server/journal/lease_entries.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "server/journal/body.h"

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;

Noted noted(const LeaseGranted& granted) {
  const auto live = std::chrono::duration_cast<std::chrono::milliseconds>(granted.terms.time_to_live);
  Json body{{"lease", granted.lease},
            {"axes", scope_of(granted.terms.scope)},
            {"time_to_live_ms", live.count()},
            {"at_loss", name(granted.terms.at_loss)}};
  if (granted.by_take_over) body["taken_over"] = true;
  return {EntryKind::lease_granted, std::move(body), granted.holder};
}

Noted noted(const LeaseEnded& ended) {
  return {EntryKind::lease_ended,
          {{"lease", ended.lease}, {"axes", scope_of(ended.scope)}, {"why", name(ended.why)}},
          ended.holder};
}

Noted noted(const Latched& latched) { return {EntryKind::latched, {{"axes", scope_of(latched.scope)}}, latched.who}; }

Noted noted(const Rearmed& rearmed) { return {EntryKind::rearmed, {{"axes", scope_of(rearmed.scope)}}, rearmed.who}; }

}  // namespace

Entry entry_of(const LeaseEvent& event, std::string device, TimePoint now) {
  return entry_of(std::visit([](const auto& one) { return noted(one); }, event), std::move(device), now);
}

}  // namespace axisgate::server::journal
