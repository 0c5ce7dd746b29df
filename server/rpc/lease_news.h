// Leases as callers write and read them.
#pragma once

#include <google/protobuf/duration.pb.h>

#include <string>

#include "axisgate/v1/control.pb.h"
#include "device/core/problem.h"
#include "server/access/leases.h"
#include "server/devices/device.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

// Seconds up to `most`; invalid_request, naming `field`, for one that is negative or longer.
Result<Duration> to_span(const google::protobuf::Duration& duration, Duration most, const std::string& field);

// unknown_axis, invalid_request.
Result<server::LeaseTerms> to_terms(const api::LeaseTerms& terms);

// With its token: for its holder.
api::Lease to_proto(const server::Lease& lease);

// Without tokens.
api::WatchLeasesResponse to_proto(const server::LeaseBoard& board);

}  // namespace axisgate::rpc
