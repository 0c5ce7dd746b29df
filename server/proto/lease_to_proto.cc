#include "server/proto/lease_to_proto.h"

#include <utility>

#include "server/events/wall_time.h"
#include "server/proto/amounts.h"
#include "server/proto/callers.h"
#include "server/proto/to_proto.h"

namespace axisgate::proto {
namespace {

using server::AtLoss;

google::protobuf::Timestamp to_stamp(TimePoint time) { return to_proto(server::to_wall(time)); }

template <class Message>
void set_scope(use::Scope scope, Message& message) {
  for (const int axis : scope.list()) message.add_axes(axis);
  message.set_whole_device(scope.is_whole_device());
}

AtLoss to_at_loss(v1::AtLoss at_loss) {
  switch (at_loss) {
    case v1::AT_LOSS_FINISH:
      return AtLoss::finish;
    case v1::AT_LOSS_STOP_AND_RELEASE:
      return AtLoss::stop_and_release;
    default:
      return AtLoss::stop;
  }
}

v1::AtLoss to_rule(AtLoss at_loss) {
  static_assert(static_cast<int>(AtLoss::finish) + 1 == v1::AT_LOSS_FINISH);
  static_assert(static_cast<int>(AtLoss::stop_and_release) + 1 == v1::AT_LOSS_STOP_AND_RELEASE);
  return static_cast<v1::AtLoss>(static_cast<int>(at_loss) + 1);
}

}  // namespace

Result<api::LeaseWish> to_wish(const v1::LeaseTerms& terms, const api::AxisNames& names) {
  const Result<stage::AxisSet> axes = to_axes(terms.axes(), names);
  if (!axes) return tl::unexpected(axes.error());
  api::LeaseWish wish{.axes = *axes, .at_loss = to_at_loss(terms.at_loss()), .purpose = terms.purpose()};
  if (terms.has_time_to_live()) wish.time_to_live = to_duration(terms.time_to_live());
  if (terms.has_expected_use()) wish.expected_use = to_duration(terms.expected_use());
  return wish;
}

v1::Lease to_proto(const server::Lease& lease) {
  v1::Lease proto;
  proto.set_token(lease.sealed_token);
  set_scope(lease.terms.scope, proto);
  *proto.mutable_holder() = to_caller(lease.holder);
  *proto.mutable_since_time() = to_stamp(lease.since);
  *proto.mutable_expire_time() = to_stamp(lease.expires);
  *proto.mutable_time_to_live() = to_proto(lease.terms.time_to_live);
  proto.set_at_loss(to_rule(lease.terms.at_loss));
  proto.set_purpose(lease.terms.purpose);
  if (lease.latch) *proto.mutable_latch() = to_proto(*lease.latch);
  if (lease.ending) proto.set_ending(text_of(*lease.ending));
  return proto;
}

v1::Latch to_proto(const server::Latch& latch) {
  v1::Latch proto;
  set_scope(latch.scope, proto);
  *proto.mutable_caller() = to_caller(latch.by);
  *proto.mutable_time() = to_stamp(latch.at);
  return proto;
}

v1::RearmResponse to_proto(const std::vector<server::Latch>& lifted) {
  v1::RearmResponse proto;
  use::Scope scope;
  for (const server::Latch& latch : lifted) {
    scope = scope | latch.scope;
    *proto.add_latches() = to_proto(latch);
  }
  set_scope(scope, proto);
  return proto;
}

v1::WatchLeasesResponse to_proto(const server::LeaseBoard& board) {
  v1::WatchLeasesResponse proto;
  for (const server::Lease& lease : board.held) {
    *proto.add_leases() = to_proto(lease);
    proto.mutable_leases()->rbegin()->clear_token();
  }
  for (const server::WaitingLease& waiting : board.waiting) {
    v1::WaitingLease& one = *proto.add_waiting();
    one.set_place(waiting.place);
    set_scope(waiting.terms.scope, one);
    *one.mutable_caller() = to_caller(waiting.holder);
    *one.mutable_since_time() = to_stamp(waiting.since);
    one.set_purpose(waiting.terms.purpose);
    if (waiting.expected_wait) *one.mutable_expected_wait() = to_proto(*waiting.expected_wait);
  }
  for (const server::Leases::HeldBack& held_back : board.held_back) {
    v1::HeldBack& one = *proto.add_held_back();
    *one.mutable_caller() = to_caller(held_back.who);
    *one.mutable_latch() = to_proto(held_back.latch);
  }
  return proto;
}

}  // namespace axisgate::proto
