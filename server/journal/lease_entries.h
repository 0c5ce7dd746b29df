// What the journal keeps of leases, latches and rearms.
#pragma once

#include <string>

#include "server/access/lease.h"
#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Without the purpose of a lease, which is text of a person.
Entry entry_of(const LeaseEvent& event, std::string device, TimePoint now);

}  // namespace axisgate::server::journal
