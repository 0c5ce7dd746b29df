#include "server/proto/problem.h"

#include <cstddef>

#include "device/core/escape.h"

namespace axisgate::proto {
namespace {

// Exceeds the length of any line of a controller.
constexpr std::size_t kDeviceTextMax = 512;

// Both enums have the same numbers; those of the API's file must not change.
static_assert(static_cast<int>(Reason::unspecified) == v1::REASON_UNSPECIFIED);
static_assert(static_cast<int>(Reason::axis_busy) == v1::REASON_AXIS_BUSY);
static_assert(static_cast<int>(Reason::link_down) == v1::REASON_LINK_DOWN);
static_assert(static_cast<int>(Reason::deadline_passed) == v1::REASON_DEADLINE_PASSED);
static_assert(static_cast<int>(Reason::internal) == v1::REASON_INTERNAL);
static_assert(static_cast<int>(kLastReason) == v1::REASON_NOT_CONFIRMED);

}  // namespace

v1::Problem to_proto(const Problem& problem, const Metadata& metadata) {
  v1::Problem proto;
  proto.set_reason(static_cast<v1::Reason>(problem.reason));
  proto.set_message(problem.message);
  proto.set_hint(problem.hint);
  if (problem.axis) proto.set_axis(*problem.axis);
  proto.set_sent(escaped(problem.sent, kDeviceTextMax));
  proto.set_wire_reply(escaped(problem.wire_reply, kDeviceTextMax));
  proto.mutable_metadata()->insert(metadata.begin(), metadata.end());
  return proto;
}

}  // namespace axisgate::proto
