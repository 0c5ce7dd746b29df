// One run of axisctl: its options, and the connection to the daemon.
#pragma once

#include "axisgate/v1/device.pb.h"
#include "clients/axisctl/arguments/options.h"
#include "clients/axisctl/connection.h"

namespace axisgate::axisctl {

struct Session {
  const Options& options;
  const Connection connection;
};

// The following functions return devices as the daemon lists them, without asking the controllers. All throw Failure.

// Returns the stage named by --device, or the only stage.
v1::Device chosen_device(const Session& session);
// Returns the only mill. If --device names a mill, there is no need to ask the daemon.
v1::Device only_mill(const Session& session);
// Returns the device named by --device, of any kind. Without --device, the only stage, or the only mill if there is no
// stage.
v1::Device any_device(const Session& session);

// Reports whether the device has no axes that could be moved one by one.
bool is_mill(const v1::Device& device);

}  // namespace axisgate::axisctl
