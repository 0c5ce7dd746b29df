// The kinds of device that the gateway knows.
#pragma once

#include "server/config/config.h"

namespace axisgate::server {

DeviceKinds device_kinds();

}  // namespace axisgate::server
