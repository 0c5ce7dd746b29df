#include "server/api/sharing/leases.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/api/request/names.h"
#include "server/api/stage/targets.h"
#include "server/limits.h"

namespace axisgate::api {
namespace {

using server::Lease;
using server::LeaseTerms;
using LeaseTurn = TurnOf<server::Device>;

constexpr std::size_t kPurposeMax = 200;

// Checks a span with a resolution of 1 s: less than 1 s beyond `most` counts as `most`.
Result<Duration> check_span(Duration span, Duration most, std::string_view field) {
  using std::chrono::seconds;
  if (span >= Duration::zero() && std::chrono::floor<seconds>(span) <= most) return std::min(span, most);
  return fail(Reason::invalid_request,
              fmt::format("{} is not between 0 and {} s", field, std::chrono::duration_cast<seconds>(most).count()));
}

Result<void> fill_times(const LeaseWish& wish, LeaseTerms& terms) {
  if (wish.time_to_live) {
    const auto live = check_span(*wish.time_to_live, server::kLeaseTimeToLiveMax, "terms.time_to_live");
    if (!live) return tl::unexpected(live.error());
    if (*live < server::kLeaseTimeToLiveMin) {
      return fail(Reason::invalid_request, "terms.time_to_live is shorter than 1 s",
                  "a lease that must be renewed so often would be lost by chance");
    }
    terms.time_to_live = *live;
  }
  if (!wish.expected_use) return {};
  const auto use = check_span(*wish.expected_use, server::kLeaseExpectedUseMax, "terms.expected_use");
  if (!use) return tl::unexpected(use.error());
  terms.expected_use = *use;
  return {};
}

// An unknown device is refused later, by its name.
Result<use::Scope> scope_of(const LeaseWish& wish, const Result<server::Device*>& device) {
  if (wish.axes.empty()) return device ? (*device)->whole() : use::Scope();
  if (!device) return use::Scope(wish.axes);
  if (!(*device)->whole().is_whole_device()) {
    return check_axes(wish.axes, **device).map([&wish] { return use::Scope(wish.axes); });
  }
  return fail(Reason::invalid_request, fmt::format("{} has no axes that could be leased one by one", (*device)->name()),
              "name no axes: the lease is then over the whole device");
}

Result<LeaseTerms> checked_terms(const Result<LeaseWish>& wish, const Result<server::Device*>& device) {
  if (!wish) return tl::unexpected(wish.error());
  const Result<use::Scope> scope = scope_of(*wish, device);
  if (!scope) return tl::unexpected(scope.error());
  LeaseTerms terms;
  terms.scope = *scope;
  terms.at_loss = wish->at_loss;
  terms.purpose = wish->purpose;
  if (const auto filled = fill_times(*wish, terms); !filled) return tl::unexpected(filled.error());
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  if (terms.purpose.size() > kPurposeMax || !std::ranges::all_of(terms.purpose, printable)) {
    return fail(Reason::invalid_request,
                fmt::format("terms.purpose is not at most {} printable ASCII characters", kPurposeMax));
  }
  return terms;
}

Answer<std::optional<Lease>> answering(std::shared_ptr<LeaseSeeker> seeker) {
  return [seeker = std::move(seeker)](Result<std::optional<Lease>> lease) { (void)seeker->answer(std::move(lease)); };
}

// Releases the lease if the caller has disconnected meanwhile, because nobody else would release it.
server::Leases::OnLease handing_to(std::shared_ptr<LeaseSeeker> seeker, server::Device& device) {
  return [seeker = std::move(seeker), &device](const Result<Lease>& lease) {
    if (!lease) return static_cast<void>(seeker->answer(tl::unexpected(lease.error())));
    if (seeker->answer(*lease)) return;
    device.post(
        [token = lease->token](server::Leases& leases, TimePoint later) { (void)leases.release(token, later); });
  };
}

// Reports no latches, because axes that were stopped after the first request stay latched.
void repeat_rearm(server::Device&, const Result<Known>& known, const Answer<std::vector<server::Latch>>& answer) {
  known ? answer(std::vector<server::Latch>()) : answer(tl::unexpected(known.error()));
}

class LeaseWatch final : public Subscription<Board> {
 public:
  LeaseWatch(server::Device& device, Streams::Place place) : Subscription(std::move(place)), device_(device) {}

 private:
  void begin() override {
    woken_by(device_.newest_leases());
    wake();
  }
  Reading read() override {
    const auto newest = device_.newest_leases().get();
    if (newest.version == taken_) return Nothing{};
    taken_ = newest.version;
    return newest.value;
  }

  server::Device& device_;
  std::optional<std::uint64_t> taken_;  // version that was delivered last
};

}  // namespace

// Does not use the request memory: a lease whose answer does not reach its caller is released, so that a repeated
// request acquires one again.
void Leases::acquire(const Call& call, std::string_view device, const Result<LeaseWish>& wish, Duration wait,
                     const std::shared_ptr<LeaseSeeker>& seeker) const {
  const Result<server::Device*> found = find_device(gateway_, device);
  const Result<LeaseTerms> terms = checked_terms(wish, found);
  const Result<Duration> waits =
      terms ? check_span(wait, server::kLeaseWaitMax, "wait") : tl::unexpected(terms.error());
  pipeline_.ask({RequestKind::acquire_lease, call, found, fault_of(waits)}, answering(seeker),
                [seeker, terms, wait = waits.value_or(Duration()), validate_only = call.validate_only](
                    const LeaseTurn& turn, const Answer<std::optional<Lease>>& respond) {
                  if (validate_only) return respond(std::nullopt);
                  server::Device& here = turn.device;
                  LeaseTerms theirs = *terms;
                  theirs.session = turn.context.session;
                  const std::uint64_t id =
                      turn.controller.acquire(std::move(theirs), turn.context.who, wait > Duration::zero(),
                                              turn.now + wait, turn.now, handing_to(seeker, here));
                  if (id == 0) return;
                  seeker->when_gone([&here, id] {
                    here.post([id](server::Leases& leases, TimePoint later) { leases.withdraw(id, later); });
                  });
                });
}

void Leases::take_over(const Call& call, std::string_view device, const Result<LeaseWish>& wish,
                       const std::shared_ptr<LeaseSeeker>& seeker) const {
  const Result<server::Device*> found = find_device(gateway_, device);
  const Result<LeaseTerms> terms = checked_terms(wish, found);
  pipeline_.ask({RequestKind::take_over_lease, call, found, fault_of(terms)}, answering(seeker),
                [seeker, terms, validate_only = call.validate_only](const LeaseTurn& turn,
                                                                    const Answer<std::optional<Lease>>& respond) {
                  if (validate_only) return respond(std::nullopt);
                  LeaseTerms theirs = *terms;
                  theirs.session = turn.context.session;
                  turn.controller.take_over(std::move(theirs), turn.context.who, turn.now,
                                            handing_to(seeker, turn.device));
                });
}

void Leases::renew(const Call& call, std::string_view device, Answer<server::Lease> answer) const {
  pipeline_.ask({RequestKind::renew_lease, call, find_device(gateway_, device)}, std::move(answer),
                [](const LeaseTurn& turn, const Answer<server::Lease>& respond) {
                  respond(turn.controller.keep_alive(turn.context.lease, turn.now));
                });
}

void Leases::release(const Call& call, std::string_view device, Answer<void> answer) const {
  pipeline_.once({RequestKind::release_lease, call, find_device(gateway_, device)}, std::move(answer),
                 [](const LeaseTurn& turn, const Answer<void>& respond) {
                   respond(turn.controller.release(turn.context.lease, turn.now));
                 });
}

void Leases::hand_over(const Call& call, std::string_view device, const std::string& to, Answer<void> answer) const {
  pipeline_.once({RequestKind::hand_over_lease, call, find_device(gateway_, device)}, std::move(answer),
                 [to](const LeaseTurn& turn, const Answer<void>& respond) {
                   respond(turn.controller.hand_over(turn.context.lease, to, turn.now));
                 });
}

void Leases::rearm(const Call& call, std::string_view device, Answer<std::vector<server::Latch>> answer) const {
  pipeline_.once(
      {RequestKind::rearm, call, find_device(gateway_, device)}, std::move(answer),
      [](const LeaseTurn& turn, const Answer<std::vector<server::Latch>>& respond) {
        respond(turn.controller.rearm(turn.context.lease, turn.context.who, turn.now));
      },
      repeat_rearm);
}

Result<std::shared_ptr<LeaseKeeping>> Leases::keep_alive(const Call& call) const {
  const auto caller = admission_.check_role(RequestKind::keep_lease_alive, call.credential);
  if (!caller) return tl::unexpected(caller.error());
  Result<Streams::Place> place = streams_.take(RequestKind::keep_lease_alive, caller->who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<LeaseKeeping>(gateway_, *std::move(place));
}

Opened<Board> Leases::watch(const Call& call, std::string_view device) const {
  const auto admitted = pipeline_.admit({RequestKind::watch_leases, call, find_device(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  Result<Streams::Place> place = streams_.take(RequestKind::watch_leases, admitted->caller.who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<LeaseWatch>(*admitted->device, *std::move(place));
}

}  // namespace axisgate::api
