// Right of callers to use axes now, and the latches of stops.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/core/spans.h"
#include "server/access/access.h"
#include "server/access/leases.h"

namespace axisgate::server {
namespace {

using use::Use;

Problem stopped_problem(const Latch& latch, TimePoint now) {
  return {.reason = Reason::stopped_by,
          .message = fmt::format("{} stopped {} ({} ago): your motions there are refused until you rearm", latch.by,
                                 to_string(latch.scope), for_people(now - latch.at)),
          .hint = "find out why, then rearm: `Rearm`"};
}

bool is_same_caller(const std::string& one, const std::string& other) {
  return one == other || (is_anonymous(one) && is_anonymous(other));
}

bool is_same_program(const std::string& one, const std::string& other) {
  return !one.empty() && one == other && guarded(Guard::own_stop_holds_nobody_back);
}

// Adds a stop to the latch of a lease. Returns true if more axes are latched than before. The holder's own stop does
// not replace the name and time of an earlier one.
bool latch(Lease& lease, const Latch& stop) {
  const Scope before = lease.latch ? lease.latch->scope : Scope();
  const Scope scope = stop.scope | before;
  const bool keeps = lease.latch && is_certainly(lease.holder, stop.by);
  lease.latch = Latch{scope, keeps ? lease.latch->by : stop.by, keeps ? lease.latch->at : stop.at};
  return scope != before;
}

bool holds_back(const Leases::HeldBack& one, const std::string& who) {
  return is_anonymous(who) ? one.anonymous : one.who == who;
}

}  // namespace

Result<void> Leases::authorize(const Use& use, TimePoint now) {
  if (use.scope.empty()) return {};
  expire(now);
  for (const HeldBack& one : held_back_) {
    const bool concerns = holds_back(one, use.who) && one.latch.scope.touches(use.scope);
    if (concerns && guarded(Guard::latch_without_lease)) return tl::unexpected(stopped_problem(one.latch, now));
  }
  return use.lease != 0 ? authorize_leased(use, now) : may_borrow(use, now);
}

Result<void> Leases::authorize_leased(const Use& use, TimePoint now) {
  const Held* held = find(use.lease);
  if (held == nullptr) return tl::unexpected(lost_problem(use.lease));
  const Lease& lease = held->lease;
  const bool continues = held->continues && running_.contains(use.activity);
  if (lease.ending && !continues) return tl::unexpected(lost_problem(use.lease));
  if (!lease.terms.scope.contains(use.scope) && guarded(Guard::lease_axes)) {
    return fail(
        Reason::outside_lease,
        fmt::format("the lease is over {}, and this needs {}", to_string(lease.terms.scope), to_string(use.scope)),
        "acquire a lease over all that the command needs");
  }
  if (lease.latch && lease.latch->scope.touches(use.scope) && guarded(Guard::latch_of_lease)) {
    return tl::unexpected(stopped_problem(*lease.latch, now));
  }
  return {};
}

Result<void> Leases::may_borrow(const Use& use, TimePoint now) {
  if (const auto running = running_.find(use.activity); running != running_.end()) {
    if (!running->second.revoked) return {};
    return fail(Reason::lease_lost,
                fmt::format("another caller took {} over while the motion ran", to_string(use.scope)));
  }
  const auto in_the_way = held_problem(use.scope, now);
  if (in_the_way && guarded(Guard::lease_keeps_others_out)) return tl::unexpected(*in_the_way);
  return {};
}

void Leases::stop_asked(const Use& stop, const std::vector<Use>& waiting, TimePoint now) {
  expire(now);
  std::map<std::string, Scope> latched, moved;
  for (Held& held : held_) {
    const Scope hit = held.lease.terms.scope & stop.scope;
    const bool own = held.lease.token == stop.lease || is_same_program(held.lease.terms.session, stop.session);
    if (hit.empty() || own) continue;
    if (latch(held.lease, {hit, stop.who, now})) latched[held.lease.holder] = latched[held.lease.holder] | hit;
  }
  const auto add = [&](const Use& use) {
    const bool by_holder = use.lease != 0 && use.lease == stop.lease;
    const bool own = by_holder || is_certainly(use.who, stop.who) || is_same_program(use.session, stop.session);
    if (!own) moved[use.who] = moved[use.who] | (use.scope & stop.scope);
  };
  for (const auto& [id, running] : running_) add(running.use);
  for (const Use& use : waiting) add(use);
  for (const Mover& mover : movers_) {
    if (now < mover.until) add(mover.use);
  }
  for (const auto& [who, scope] : moved) {
    if (scope.empty()) continue;
    if (hold_back(who, {scope, stop.who, now})) latched[who] = latched[who] | scope;
  }
  for (const auto& [who, scope] : latched) report(Latched{who, scope}, now);
  changed(now);
}

// Keeps the newest use by each caller and lease of the same axes.
void Leases::note_mover(Use use, TimePoint now) {
  std::erase_if(movers_, [&](const Mover& one) {
    const bool same = is_same_caller(one.use.who, use.who) && one.use.lease == use.lease && one.use.scope == use.scope;
    return same || now >= one.until;
  });
  movers_.push_back({std::move(use), now + kMovedLately});
}

// Notes that `who` is held back. Stops of one caller by one other caller share an entry, so that no caller fills the
// list alone. Returns true if more axes are latched than before.
bool Leases::hold_back(const std::string& who, const Latch& latch) {
  const auto known = std::ranges::find_if(held_back_, [&](const HeldBack& one) {
    return is_same_caller(one.who, who) && is_same_caller(one.latch.by, latch.by);
  });
  Scope before;
  if (known != held_back_.end()) {
    before = known->latch.scope;
    held_back_.erase(known);
  }
  const Scope scope = latch.scope | before;
  if (held_back_.size() == kHeldBackMax) held_back_.erase(held_back_.begin());
  held_back_.push_back({who, {scope, latch.by, latch.at}});
  return scope != before;
}

std::vector<Latch> Leases::rearm(LeaseToken token, const std::string& who, TimePoint now) {
  std::vector<Latch> lifted;
  // One stop may have latched both the lease and the caller that moved under it.
  const auto lift = [&](const Latch& latch) {
    const auto same = [&](const Latch& one) { return one.by == latch.by && one.at == latch.at; };
    const auto known = std::ranges::find_if(lifted, same);
    if (known == lifted.end()) return lifted.push_back(latch);
    known->scope = known->scope | latch.scope;
  };
  for (Held& held : held_) {
    const bool callers = held.lease.token == token || is_certainly(held.lease.holder, who);
    if (callers && held.lease.latch) lift(*std::exchange(held.lease.latch, {}));
  }
  for (HeldBack& one : held_back_) {
    if (!holds_back(one, who)) continue;
    lift(one.latch);
    one.anonymous = false;
  }
  std::erase_if(held_back_, [&](const HeldBack& one) { return is_same_caller(one.who, who); });
  Scope scope;
  for (const Latch& latch : lifted) scope = scope | latch.scope;
  if (!lifted.empty()) report(Rearmed{who, scope}, now);
  changed(now);
  return lifted;
}

}  // namespace axisgate::server
