#include "server/rpc/lease_news.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/events/wall_time.h"
#include "server/rpc/amounts.h"
#include "server/rpc/news.h"

namespace axisgate::rpc {
namespace {

using server::AtLoss;
using server::LeaseTerms;

constexpr std::size_t kPurposeMax = 200;

google::protobuf::Duration to_proto(Duration span) {
  google::protobuf::Duration proto;
  const auto seconds = std::chrono::floor<std::chrono::seconds>(span);
  proto.set_seconds(seconds.count());
  proto.set_nanos(static_cast<std::int32_t>((span - seconds).count()));
  return proto;
}

google::protobuf::Timestamp to_proto(TimePoint time) { return rpc::to_proto(server::to_wall(time)); }

template <class Repeated>
void fill(Repeated& axes, stage::AxisSet set) {
  for (const int axis : set.list()) axes.Add(axis);
}

AtLoss to_at_loss(api::AtLoss at_loss) {
  switch (at_loss) {
    case api::AT_LOSS_FINISH:
      return AtLoss::finish;
    case api::AT_LOSS_STOP_AND_RELEASE:
      return AtLoss::stop_and_release;
    default:
      return AtLoss::stop;
  }
}

api::AtLoss to_proto(AtLoss at_loss) {
  static_assert(static_cast<int>(AtLoss::finish) + 1 == api::AT_LOSS_FINISH);
  static_assert(static_cast<int>(AtLoss::stop_and_release) + 1 == api::AT_LOSS_STOP_AND_RELEASE);
  return static_cast<api::AtLoss>(static_cast<int>(at_loss) + 1);
}

api::Latch to_proto(const server::Latch& latch) {
  api::Latch proto;
  fill(*proto.mutable_axes(), latch.axes);
  proto.set_by(latch.by);
  *proto.mutable_time() = to_proto(latch.at);
  return proto;
}

}  // namespace

Result<Duration> to_span(const google::protobuf::Duration& duration, Duration most, const std::string& field) {
  const std::int64_t limit = std::chrono::duration_cast<std::chrono::seconds>(most).count();
  if (duration.seconds() < 0 || duration.nanos() < 0 || duration.seconds() > limit) {
    return fail(Reason::invalid_request, fmt::format("{} is not between 0 and {} s", field, limit));
  }
  return std::min<Duration>(most,
                            std::chrono::seconds(duration.seconds()) + std::chrono::nanoseconds(duration.nanos()));
}

Result<LeaseTerms> to_terms(const api::LeaseTerms& terms) {
  LeaseTerms wanted;
  const Result<stage::AxisSet> axes = to_axes(terms.axes());
  if (!axes) return tl::unexpected(axes.error());
  wanted.axes = axes->empty() ? stage::AxisSet::all() : *axes;
  if (terms.has_time_to_live()) {
    const auto live = to_span(terms.time_to_live(), LeaseTerms::kTimeToLiveMax, "terms.time_to_live");
    if (!live) return tl::unexpected(live.error());
    if (*live < LeaseTerms::kTimeToLiveMin) {
      return fail(Reason::invalid_request, "terms.time_to_live is shorter than 1 s",
                  "a lease that must be renewed so often would be lost by chance");
    }
    wanted.time_to_live = *live;
  }
  wanted.at_loss = to_at_loss(terms.at_loss());
  if (terms.has_expected_use()) {
    const auto use = to_span(terms.expected_use(), std::chrono::hours(24 * 365), "terms.expected_use");
    if (!use) return tl::unexpected(use.error());
    wanted.expected_use = *use;
  }
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  if (terms.purpose().size() > kPurposeMax || !std::ranges::all_of(terms.purpose(), printable)) {
    return fail(Reason::invalid_request,
                fmt::format("terms.purpose is not at most {} printable ASCII characters", kPurposeMax));
  }
  wanted.purpose = terms.purpose();
  return wanted;
}

api::Lease to_proto(const server::Lease& lease) {
  api::Lease proto;
  proto.set_token(lease.token);
  fill(*proto.mutable_axes(), lease.terms.axes);
  proto.set_holder(lease.holder);
  *proto.mutable_since_time() = to_proto(lease.since);
  *proto.mutable_expire_time() = to_proto(lease.expires);
  *proto.mutable_time_to_live() = to_proto(lease.terms.time_to_live);
  proto.set_at_loss(to_proto(lease.terms.at_loss));
  proto.set_purpose(lease.terms.purpose);
  if (lease.latch) *proto.mutable_latch() = to_proto(*lease.latch);
  proto.set_ending(lease.ending);
  return proto;
}

api::WatchLeasesResponse to_proto(const server::LeaseBoard& board) {
  api::WatchLeasesResponse proto;
  for (const server::Lease& lease : board.held) {
    *proto.add_leases() = to_proto(lease);
    proto.mutable_leases()->rbegin()->clear_token();
  }
  for (const server::WaitingLease& waiting : board.waiting) {
    api::WaitingLease& one = *proto.add_waiting();
    one.set_place(waiting.place);
    fill(*one.mutable_axes(), waiting.terms.axes);
    one.set_holder(waiting.holder);
    *one.mutable_since_time() = to_proto(waiting.since);
    one.set_purpose(waiting.terms.purpose);
    if (waiting.expected_wait) *one.mutable_expected_wait() = to_proto(*waiting.expected_wait);
  }
  for (const server::Leases::HeldBack& held_back : board.held_back) {
    api::HeldBack& one = *proto.add_held_back();
    one.set_who(held_back.who);
    *one.mutable_latch() = to_proto(held_back.latch);
  }
  return proto;
}

}  // namespace axisgate::rpc
