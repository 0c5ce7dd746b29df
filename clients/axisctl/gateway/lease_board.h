// Board of a device's leases: who holds axes, who waits for them, and who must rearm.
#pragma once

#include <fmt/format.h>

#include <string>

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Returns "axes 1, 2" or "the whole device". `covering`: a Lease, a WaitingLease, a Latch or a RearmResponse.
template <class Message>
std::string scope_text(const Message& covering) {
  if (covering.whole_device()) return "the whole device";
  return fmt::format("{} {}", covering.axes_size() == 1 ? "axis" : "axes", fmt::join(covering.axes(), ", "));
}

std::string latch_text(const v1::Latch& latch);

// Requests the present board of the device. Throws Failure.
v1::WatchLeasesResponse board_now(const Session& session, const std::string& device);

}  // namespace axisgate::axisctl
