// The kinds of device that the gateway knows.
#pragma once

#include "server/config/config.h"

namespace axisgate::server {

// The first is that of a device whose table names none.
DeviceKinds device_kinds();

}  // namespace axisgate::server
