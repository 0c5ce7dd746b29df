// Who may use which axes now, and whom a stop holds back.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "server/access/leases.h"
#include "server/access/spans.h"

namespace axisgate::server {
namespace {

using stage::to_string;
using stage::Use;

Problem stopped_problem(const Latch& latch, TimePoint now) {
  return {.reason = Reason::stopped_by,
          .message = fmt::format("{} stopped {} ({} ago): your motions there are refused until you rearm", latch.by,
                                 to_string(latch.axes), for_people(now - latch.at)),
          .hint = "find out why, then type `axisctl rearm` (with a lease: inside its `lease run`)"};
}

}  // namespace

Result<void> Leases::authorize(const Use& use, TimePoint now) {
  if (use.axes.empty()) return {};
  expire(now);
  for (const HeldBack& one : held_back_) {
    const bool concerns = one.who == use.who && one.latch.axes.touches(use.axes);
    if (concerns && guarded(Guard::latch_without_lease)) return tl::unexpected(stopped_problem(one.latch, now));
  }
  return use.lease != 0 ? authorize_leased(use, now) : may_borrow(use, now);
}

Result<void> Leases::authorize_leased(const Use& use, TimePoint now) {
  const Held* held = find(use.lease);
  if (held == nullptr) return tl::unexpected(lost_problem(use.lease));
  const Lease& lease = held->lease;
  const bool continues = held->continues && running_.contains(use.motion);
  if (!lease.ending.empty() && !continues) return tl::unexpected(lost_problem(use.lease));
  if (!lease.terms.axes.contains(use.axes) && guarded(Guard::lease_axes)) {
    return fail(
        Reason::outside_lease,
        fmt::format("the lease is over {}, and this needs {}", to_string(lease.terms.axes), to_string(use.axes)),
        "acquire a lease over all that the command needs");
  }
  if (lease.latch && lease.latch->axes.touches(use.axes) && guarded(Guard::latch_of_lease)) {
    return tl::unexpected(stopped_problem(*lease.latch, now));
  }
  return {};
}

Result<void> Leases::may_borrow(const Use& use, TimePoint now) {
  if (const auto running = running_.find(use.motion); running != running_.end()) {
    if (!running->second.revoked) return {};
    return fail(Reason::lease_lost, "the axes were taken over while the motion ran");
  }
  const auto in_the_way = held_problem(use.axes, now);
  if (in_the_way && guarded(Guard::lease_keeps_others_out)) return tl::unexpected(*in_the_way);
  return {};
}

void Leases::stop_asked(const Use& stop, TimePoint now) {
  expire(now);
  for (Held& held : held_) {
    const AxisSet hit = held.lease.terms.axes & stop.axes;
    if (hit.empty() || held.lease.token == stop.lease) continue;
    const AxisSet before = held.lease.latch ? held.lease.latch->axes : AxisSet();
    held.lease.latch = Latch{before | hit, stop.who, now};
  }
  std::map<std::string, AxisSet> borrowers;
  for (const auto& [id, running] : running_) {
    if (running.use.lease == 0)
      borrowers[running.use.who] = borrowers[running.use.who] | (running.use.axes & stop.axes);
  }
  for (const int axis : stop.axes.list()) {
    const Borrowed& last = borrowed_[static_cast<std::size_t>(axis - 1)];
    if (now < last.until) borrowers[last.who].add(axis);
  }
  for (const auto& [who, axes] : borrowers) {
    if (axes.empty() || who == stop.who) continue;
    if (held_back_.size() == kHeldBackMax) held_back_.erase(held_back_.begin());
    held_back_.push_back({who, {axes, stop.who, now}});
  }
  changed(now);
}

Result<AxisSet> Leases::rearm(LeaseToken token, const std::string& who, TimePoint now) {
  AxisSet lifted;
  if (token != 0) {
    const auto held = find_held(token, now);
    if (!held) return tl::unexpected(held.error());
    if (const auto latch = std::exchange((*held)->lease.latch, {})) lifted = latch->axes;
  }
  for (const HeldBack& one : held_back_) {
    if (one.who == who) lifted = lifted | one.latch.axes;
  }
  std::erase_if(held_back_, [&](const HeldBack& one) { return one.who == who; });
  changed(now);
  return lifted;
}

}  // namespace axisgate::server
