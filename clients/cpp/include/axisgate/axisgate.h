// Everything of the package.
#pragma once

#include "axisgate/errors.h"   // IWYU pragma: export
#include "axisgate/events.h"   // IWYU pragma: export
#include "axisgate/jog.h"      // IWYU pragma: export
#include "axisgate/lease.h"    // IWYU pragma: export
#include "axisgate/motion.h"   // IWYU pragma: export
#include "axisgate/places.h"   // IWYU pragma: export
#include "axisgate/results.h"  // IWYU pragma: export
#include "axisgate/stage.h"    // IWYU pragma: export
#include "axisgate/state.h"    // IWYU pragma: export
#include "axisgate/units.h"    // IWYU pragma: export
