#include "device/core/guard.h"

// What is installed has all its guards: it could not even be told to do without one.
static_assert(axisgate::guarded(axisgate::Guard::barrier_after_time_limit));
