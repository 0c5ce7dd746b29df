#include "device/core/guard.h"

// The installed program has all its guards: there is not even a setting that removes one.
static_assert(axisgate::guarded(axisgate::Guard::barrier_after_time_limit));
