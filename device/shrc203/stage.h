// Names of device/stage, which every stage controller uses, made available in this namespace.
#pragma once

#include "device/stage/axes.h"
#include "device/stage/event.h"
#include "device/stage/motion.h"
#include "device/stage/permission.h"
#include "device/stage/profile.h"
#include "device/stage/requests.h"
#include "device/stage/state.h"
#include "device/stage/trigger.h"

namespace axisgate::shrc203 {

using namespace stage;  // NOLINT(google-build-using-namespace)

}  // namespace axisgate::shrc203
