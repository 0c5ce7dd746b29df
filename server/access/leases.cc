#include "server/access/leases.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/core/spans.h"
#include "server/access/access.h"
#include "server/access/lease_tokens.h"

namespace axisgate::server {
namespace {

using use::Use;

}  // namespace

Leases::Held* Leases::find(LeaseToken token) {
  const auto found = std::ranges::find_if(held_, [token](const Held& held) { return held.lease.token == token; });
  return found == held_.end() ? nullptr : &*found;
}

Problem Leases::lost_problem(LeaseToken token) const {
  const auto ended = std::ranges::find_if(ended_, [token](const Ended& one) { return one.token == token; });
  return {.reason = Reason::lease_lost,
          .message = ended == ended_.end() ? kNoSuchLease : "the lease has ended: " + text_of(ended->ending),
          .hint = "acquire another one: `AcquireLease`"};
}

Result<Leases::Held*> Leases::find_held(LeaseToken token, TimePoint now) {
  expire(now);
  Held* held = find(token);
  if (held == nullptr || held->lease.ending) return tl::unexpected(lost_problem(token));
  return held;
}

bool Leases::runs(LeaseToken token) const {
  return std::ranges::any_of(running_, [token](const auto& entry) { return entry.second.use.lease == token; });
}

std::uint64_t Leases::acquire(LeaseTerms terms, const std::string& holder, bool wait, TimePoint not_after,
                              TimePoint now, OnLease answer) {
  expire(now);
  const auto problem = in_the_way(terms.scope, now);
  if (!wait && problem) {
    answer(tl::unexpected(*problem));
    return 0;
  }
  if (waiting_.size() >= kWaitingMax) {
    answer(fail(Reason::queue_full, fmt::format("{} already wait for this device", waiting_.size()),
                "try again when fewer wait"));
    return 0;
  }
  const std::uint64_t id = ++last_waiting_;
  waiting_.push_back({{id, holder, std::move(terms), now, 1, {}}, not_after, std::move(answer)});
  settle(now);
  const bool waits = std::ranges::any_of(waiting_, [id](const Waiting& waiting) { return waiting.lease.id == id; });
  return waits ? id : 0;
}

void Leases::withdraw(std::uint64_t waiting, TimePoint now) {
  const auto found = std::ranges::find_if(waiting_, [waiting](const Waiting& one) { return one.lease.id == waiting; });
  if (found == waiting_.end()) return;
  const OnLease answer = std::move(found->answer);
  waiting_.erase(found);
  answer(fail(Reason::not_sent, "the lease is no longer waited for"));
  settle(now);
}

Result<Lease> Leases::keep_alive(LeaseToken token, TimePoint now) {
  const auto held = find_held(token, now);
  if (!held) return tl::unexpected(held.error());
  (*held)->lease.expires = now + (*held)->lease.terms.time_to_live;
  changed(now);
  return (*held)->lease;
}

void Leases::lost(LeaseToken token, TimePoint now) {
  const auto held = find_held(token, now);
  if (!held || (*held)->lease.terms.at_loss == AtLoss::finish) return;
  const Lease& lease = (*held)->lease;
  if (runs(token)) order_stop(lease.terms.scope, lease.holder);
  if (lease.terms.at_loss == AtLoss::stop_and_release) {
    end_lease(**held, {LeaseEnding::Why::cut_off}, false, now);
  }
  settle(now);
}

void Leases::cut_off(const std::string& holder, const std::string& by, TimePoint now) {
  for (Held& held : held_) {
    if (held.lease.holder == holder && !held.lease.ending) {
      end_unkept(held, {LeaseEnding::Why::token_revoked, by}, now);
    }
  }
  std::vector<std::uint64_t> waits;
  for (const Waiting& waiting : waiting_) {
    if (waiting.lease.holder == holder) waits.push_back(waiting.lease.id);
  }
  for (const std::uint64_t id : waits) withdraw(id, now);
  settle(now);
}

Result<void> Leases::release(LeaseToken token, TimePoint now) {
  const auto held = find_held(token, now);
  if (!held) return tl::unexpected(held.error());
  end_lease(**held, {LeaseEnding::Why::released}, true, now);
  settle(now);
  return {};
}

Result<void> Leases::hand_over(LeaseToken token, const std::string& to, TimePoint now) {
  const auto held = find_held(token, now);
  if (!held) return tl::unexpected(held.error());
  const Scope scope = (*held)->lease.terms.scope;
  const auto next = std::ranges::find_if(waiting_, [&](const Waiting& waiting) {
    return waiting.lease.holder == to && scope.contains(waiting.lease.terms.scope);
  });
  if (next == waiting_.end()) {
    return fail(Reason::not_found, fmt::format("nobody named \"{}\" waits for {} alone", to, to_string(scope)),
                "`WatchLeases` shows who waits");
  }
  if (runs(token)) {
    return fail(Reason::axis_busy, "a motion runs under the lease", "hand it over when it has ended, or stop it");
  }
  end_lease(**held, {LeaseEnding::Why::handed_over, to}, false, now);
  Waiting waiting = std::move(*next);
  waiting_.erase(next);
  waiting.not_after = TimePoint::max();  // granted in any case, as soon as the settings are restored
  waiting_.push_front(std::move(waiting));
  settle(now);
  return {};
}

void Leases::take_over(LeaseTerms terms, const std::string& holder, TimePoint now, OnLease answer) {
  expire(now);
  for (Held& held : held_) {
    if (!held.lease.terms.scope.touches(terms.scope)) continue;
    end_lease(held, {LeaseEnding::Why::taken_over, holder}, false, now);
  }
  for (auto& [id, running] : running_) running.revoked = running.revoked || running.use.scope.touches(terms.scope);
  order_stop(terms.scope, holder);
  waiting_.push_front({{++last_waiting_, holder, std::move(terms), now, 1, {}},
                       TimePoint::max(),
                       std::move(answer),
                       last_order_,
                       true});
  settle(now);
}

std::vector<Lease> Leases::held() const {
  std::vector<Lease> all;
  for (const Held& held : held_) {
    all.push_back(held.lease);
    all.back().sealed_token.clear();  // everybody may see these
  }
  return all;
}

std::vector<WaitingLease> Leases::waiting(TimePoint now) const {
  std::vector<WaitingLease> all;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    WaitingLease one = waiting_[i].lease;
    one.place = static_cast<int>(i) + 1;
    one.expected_wait = expected_wait(i, now);
    all.push_back(std::move(one));
  }
  return all;
}

// Returns nullopt if the holder, or a caller ahead in the queue, gave no duration.
std::optional<Duration> Leases::expected_wait(std::size_t place, TimePoint now) const {
  const Scope scope = waiting_[place].lease.terms.scope;
  Duration wait{};
  for (const Held& held : held_) {
    if (!held.lease.terms.scope.touches(scope)) continue;
    if (!held.lease.terms.expected_use) return {};
    wait = std::max(wait, held.lease.since + *held.lease.terms.expected_use - now);
  }
  for (std::size_t i = 0; i < place; ++i) {
    const LeaseTerms& terms = waiting_[i].lease.terms;
    if (!terms.scope.touches(scope)) continue;
    if (!terms.expected_use) return {};
    wait += *terms.expected_use;
  }
  return wait;
}

std::optional<Problem> Leases::held_problem(Scope scope, TimePoint now) const {
  const auto reported = [&](const LeaseTerms& terms, const std::string& who, std::string_view does, TimePoint since) {
    const std::string purpose = terms.purpose.empty() ? "" : fmt::format(" (\"{}\")", terms.purpose);
    return Problem{.reason = Reason::lease_held,
                   .message = fmt::format("{} {} {} for {}{}", who, does, to_string(terms.scope),
                                          for_people(now - since), purpose),
                   .hint = "to wait, acquire a lease with `wait`; or ask the holder to hand over"};
  };
  for (const Held& held : held_) {
    if (held.lease.terms.scope.touches(scope)) {
      return reported(held.lease.terms, held.lease.holder, "has held", held.lease.since);
    }
  }
  for (const Waiting& waiting : waiting_) {
    if (waiting.lease.terms.scope.touches(scope)) {
      return reported(waiting.lease.terms, waiting.lease.holder, "has waited for", waiting.lease.since);
    }
  }
  return {};
}

// Returns the obstacle that prevents the grant of a lease.
std::optional<Problem> Leases::in_the_way(Scope scope, TimePoint now) const {
  if (auto held = held_problem(scope, now)) return held;
  for (const auto& [id, running] : running_) {
    if (!running.use.scope.touches(scope)) continue;
    return Problem{.reason = Reason::lease_held,
                   .message = text_of(running.occupation, now),
                   .hint = "to wait until it has ended, acquire a lease with `wait`; or stop it"};
  }
  return {};
}

void Leases::begin(const Use& use, use::Occupation occupation, TimePoint) {
  running_[use.activity] = {use, std::move(occupation), false};
}

void Leases::due(ActivityId activity, TimePoint over) {
  const auto found = running_.find(activity);
  if (found != running_.end()) found->second.occupation.due = over;
}

void Leases::end(ActivityId activity, TimePoint now) {
  const auto found = running_.find(activity);
  if (found == running_.end()) return;
  note_mover(std::move(found->second.use), now);
  running_.erase(found);
  settle(now);
}

void Leases::device_restarted(TimePoint now) {
  for (Held& held : held_) {
    if (!held.lease.ending) end_lease(held, {LeaseEnding::Why::restarted}, false, now);
  }
  settle(now);
}

void Leases::end_lease(Held& held, LeaseEnding ending, bool continues, TimePoint now) {
  Lease& lease = held.lease;
  ended_.push_back({lease.token, ending});
  if (ended_.size() > kEndedKept) ended_.pop_front();
  if (!lease.ending) report(LeaseEnded{lease.token, lease.holder, lease.terms.scope, ending.why}, now);
  lease.ending = std::move(ending);
  if (lease.latch && !is_certainly(lease.holder, lease.latch->by)) hold_back(lease.holder, *lease.latch);
  held.continues = continues;
}

// Ends a lease for good, and treats its motion as AtLoss says.
void Leases::end_unkept(Held& held, LeaseEnding ending, TimePoint now) {
  const Lease& lease = held.lease;
  const bool finishes = lease.terms.at_loss == AtLoss::finish;
  if (!finishes && runs(lease.token)) order_stop(lease.terms.scope, lease.holder);
  end_lease(held, std::move(ending), finishes, now);
}

void Leases::order_stop(Scope scope, const std::string& who) { orders_.stops.push_back({++last_order_, scope, who}); }

void Leases::expire(TimePoint now) {
  for (Held& held : held_) {
    const Lease& lease = held.lease;
    if (lease.ending || now < lease.expires || !guarded(Guard::leases_expire)) continue;
    end_unkept(held, {LeaseEnding::Why::expired}, now);
  }
  std::vector<Waiting> late;
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    if (waiting->not_after >= now) {
      ++waiting;
      continue;
    }
    late.push_back(std::move(*waiting));
    waiting = waiting_.erase(waiting);
  }
  for (const Waiting& waiting : late) {
    const auto problem = in_the_way(waiting.lease.terms.scope, now);
    waiting.answer(fail(Reason::deadline_passed, "the lease was not free in the time allowed" +
                                                     (problem ? ": " + problem->message : std::string())));
  }
}

// Drops the leases that are over, and grants waiting ones.
void Leases::settle(TimePoint now) {
  drop_ended();
  while (grant(now)) drop_ended();
  changed(now);
}

bool Leases::drop_ended() {
  return std::erase_if(held_, [this](Held& held) { return is_over(held); }) > 0;
}

bool Leases::is_over(Held& held) {
  if (!held.lease.ending || runs(held.lease.token)) return false;
  if (held.settings == Settings::changed) {
    held.settings = Settings::being_restored;
    orders_.restoring.push_back({held.lease.token, held.lease.holder});
  }
  return held.settings == Settings::untouched;
}

Scope Leases::taken() const {
  Scope scope;
  for (const Held& held : held_) scope = scope | held.lease.terms.scope;
  for (const auto& [id, running] : running_) scope = scope | running.use.scope;
  return scope;
}

// Grants a single lease, because its answer may call acquire().
bool Leases::grant(TimePoint now) {
  Scope blocked = taken();
  for (auto waiting = waiting_.begin(); waiting != waiting_.end(); ++waiting) {
    if (waiting->order != 0 || blocked.touches(waiting->lease.terms.scope)) {
      blocked = blocked | waiting->lease.terms.scope;
      continue;
    }
    const Waiting next = std::move(*waiting);
    waiting_.erase(waiting);
    const Lease lease = start(next, now);
    changed(now);  // before the answer: a holder that looks at the leases sees its own
    next.answer(lease);
    return true;
  }
  return false;
}

Lease Leases::start(const Waiting& waiting, TimePoint now) {
  const LeaseToken token = tokens_.next();
  const WaitingLease& wanted = waiting.lease;
  const TimePoint expires = now + wanted.terms.time_to_live;
  held_.push_back({{token, tokens_.seal(token), wanted.holder, wanted.terms, now, expires, {}, {}}});
  report(LeaseGranted{token, wanted.holder, wanted.terms, waiting.takes_over}, now);
  return held_.back().lease;
}

void Leases::settings_changed(LeaseToken lease) {
  Held* held = find(lease);
  if (held != nullptr && held->settings == Settings::untouched) held->settings = Settings::changed;
}

void Leases::settings_restored(LeaseToken lease, TimePoint now) {
  if (Held* held = find(lease)) held->settings = Settings::untouched;
  settle(now);
}

use::Orders Leases::advance(TimePoint now) {
  expire(now);
  settle(now);
  return std::exchange(orders_, {});
}

void Leases::stopped(std::uint64_t order, TimePoint now) {
  for (Waiting& waiting : waiting_) {
    if (waiting.order == order) waiting.order = 0;
  }
  settle(now);
}

std::optional<TimePoint> Leases::next_deadline() const {
  std::optional<TimePoint> next;
  const auto sooner = [&next](TimePoint at) { next = next ? std::min(*next, at) : at; };
  if (!orders_.stops.empty() || !orders_.restoring.empty()) return TimePoint{};
  for (const Held& held : held_) {
    if (!held.lease.ending) sooner(held.lease.expires);
  }
  for (const Waiting& waiting : waiting_) {
    if (waiting.not_after != TimePoint::max()) sooner(waiting.not_after + Duration(1));
  }
  return next;
}

}  // namespace axisgate::server
