#include "device/core/guard.h"

// The installed program has all its guards and no setting that removes any of them.
static_assert(axisgate::guarded(axisgate::Guard::barrier_after_time_limit));
