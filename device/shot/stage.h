// Names of device/stage, which every stage controller uses, made available in this namespace.
#pragma once

#include "device/stage/axes.h"
#include "device/stage/event.h"
#include "device/stage/motion.h"
#include "device/stage/profile.h"
#include "device/stage/requests.h"
#include "device/stage/state.h"
#include "device/stage/trigger.h"
#include "device/use/permission.h"
#include "device/use/request_context.h"

namespace axisgate::shot {

using namespace stage;  // NOLINT(google-build-using-namespace)
using use::EndedLease;
using use::everybody_may;
using use::Occupation;
using use::Orders;
using use::Permission;
using use::RequestContext;
using use::StopOrder;
using use::Use;

}  // namespace axisgate::shot
