// Leases: their terms, their ends, and the events about them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "device/core/time.h"
#include "device/use/scope.h"
#include "server/access/lease_tokens.h"
#include "server/limits.h"

namespace axisgate::server {

using use::Scope;

// Effect on the holder's motion when the lease is no longer kept alive.
enum class AtLoss {
  finish,            // continues to its end; the axes are free then
  stop,              // is stopped; the lease lasts until it expires, so that its holder may continue
  stop_and_release,  // is stopped, and the lease ends
};
std::string_view name(AtLoss at_loss);  // "stop_and_release"

struct LeaseTerms {
  Scope scope;
  Duration time_to_live = kLeaseTimeToLive;
  AtLoss at_loss = AtLoss::stop;
  std::optional<Duration> expected_use{};  // shown to waiting callers
  std::string purpose{};                   // for people; may be empty
  std::string session{};                   // of the caller; see use::Use::session
};

// A Latch is the effect of another caller's stop: nothing moves on these axes until the stopped caller rearms.
struct Latch {
  Scope scope;
  std::string by;
  TimePoint at{};
};

// A LeaseEnding is the reason why no motion begins under the lease any longer.
struct LeaseEnding {
  enum class Why {
    released,
    expired,
    handed_over,
    taken_over,
    cut_off,        // the connection that kept it alive broke
    token_revoked,  // the bearer token of its holder was revoked
    restarted,      // the controller may have restarted
  };
  Why why = Why::released;
  std::string who{};  // receiver of the hand-over, or who took it over or revoked the token; empty otherwise
};
std::string_view name(LeaseEnding::Why why);     // "handed_over"
std::string text_of(const LeaseEnding& ending);  // "it was handed over to unix bert"

struct Lease {
  LeaseToken token = 0;
  std::string sealed_token;  // for the holder only
  std::string holder;
  LeaseTerms terms;
  TimePoint since{}, expires{};
  std::optional<LeaseEnding> ending;  // nullopt while the lease is held
  std::optional<Latch> latch;
};

struct WaitingLease {
  std::uint64_t id = 0;  // 0: none
  std::string holder;    // caller who waits
  LeaseTerms terms;
  TimePoint since{};
  int place = 1;                          // in the queue, from 1
  std::optional<Duration> expected_wait;  // nullopt if the holder, or a caller ahead in the queue, gave no duration
};

struct LeaseGranted {
  LeaseToken lease = 0;
  std::string holder;
  LeaseTerms terms;
  bool by_take_over = false;
};

// No motion begins under the lease after this event. A running motion may last longer.
struct LeaseEnded {
  LeaseToken lease = 0;
  std::string holder;
  Scope scope;
  LeaseEnding::Why why = LeaseEnding::Why::released;
};

// A stop holds this caller back from now on.
struct Latched {
  std::string who;
  Scope scope;
};

// This caller may move the axes again.
struct Rearmed {
  std::string who;
  Scope scope;
};

using LeaseEvent = std::variant<LeaseGranted, LeaseEnded, Latched, Rearmed>;

}  // namespace axisgate::server
