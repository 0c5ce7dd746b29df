// Leases as callers write and read them.
#pragma once

#include "axisgate/v1/control.pb.h"
#include "device/core/problem.h"
#include "server/access/leases.h"
#include "server/api/sharing/leases.h"
#include "server/devices/stage.h"

namespace axisgate::proto {

// unknown_axis, invalid_request.
Result<api::LeaseWish> to_wish(const v1::LeaseTerms& terms);

// With its token: for its holder.
v1::Lease to_proto(const server::Lease& lease);

v1::Latch to_proto(const server::Latch& latch);

// Without tokens.
v1::WatchLeasesResponse to_proto(const server::LeaseBoard& board);

}  // namespace axisgate::proto
