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

// As the daemon knows them without asking; all throw Failure.

// The stage that was named, or the only one.
v1::Device chosen_device(const Session& session);
// The only mill. For a mill that was named the daemon need not be asked.
v1::Device only_mill(const Session& session);
// The device that was named, whatever its kind. Otherwise the only stage, or where there is none, the only mill. One
// that the daemon does not list has its name alone.
v1::Device leased_device(const Session& session);

}  // namespace axisgate::axisctl
