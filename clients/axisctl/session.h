// One run of axisctl: what was requested, and the connection to the daemon.
#pragma once

#include "axisgate/v1/device.pb.h"
#include "clients/axisctl/connection.h"
#include "clients/axisctl/options.h"

namespace axisgate::axisctl {

struct Session {
  const Options& options;
  const Connection connection;
};

// The device that was named, or the only one, as the daemon knows it without asking. Throws Failure.
v1::Device chosen_device(const Session& session);
// The same for leases; of a mill its name alone.
v1::Device leased_device(const Session& session);

}  // namespace axisgate::axisctl
