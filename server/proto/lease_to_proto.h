// Conversion of leases from and to callers' messages.
#pragma once

#include <vector>

#include "axisgate/v1/control.pb.h"
#include "device/core/problem.h"
#include "server/access/leases.h"
#include "server/api/sharing/leases.h"
#include "server/devices/stage.h"

namespace axisgate::proto {

// Fails with unknown_axis or invalid_request.
Result<api::LeaseWish> to_wish(const v1::LeaseTerms& terms, const api::AxisNames& names);

// Includes the token, so the result is for the holder only.
v1::Lease to_proto(const server::Lease& lease);

v1::Latch to_proto(const server::Latch& latch);

// Leaves out the tokens.
v1::RearmResponse to_proto(const std::vector<server::Latch>& lifted);

v1::WatchLeasesResponse to_proto(const server::LeaseBoard& board);

}  // namespace axisgate::proto
