// Journal entries for leases, latches and rearms.
#pragma once

#include <string>

#include "server/access/lease.h"
#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Omits the purpose of a lease, which is a person's text.
Entry entry_of(const LeaseEvent& event, std::string device, TimePoint now);

}  // namespace axisgate::server::journal
