// What a lease is, how it ends, and what happens to it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "device/core/time.h"
#include "device/stage/axes.h"
#include "server/access/lease_tokens.h"

namespace axisgate::server {

using stage::AxisSet;

// What becomes of the holder's motion when nobody keeps the lease alive any more.
enum class AtLoss {
  finish,            // it continues to its end; the axes are free then
  stop,              // it is stopped; the lease lasts until it expires, so that its holder may come back
  stop_and_release,  // it is stopped, and the lease ends with it
};
std::string_view name(AtLoss at_loss);  // "stop_and_release"

struct LeaseTerms {
  static constexpr Duration kTimeToLive = std::chrono::seconds(10), kTimeToLiveMin = std::chrono::seconds(1),
                            kTimeToLiveMax = std::chrono::hours(24);
  AxisSet axes;
  Duration time_to_live = kTimeToLive;
  AtLoss at_loss = AtLoss::stop;
  std::optional<Duration> expected_use{};  // for those who wait
  std::string purpose{};                   // for people; may be empty
  std::string session{};                   // stage::Use::session of its caller
};

// A stop by another: nothing moves there until the caller who was stopped rearms.
struct Latch {
  AxisSet axes;
  std::string by;
  TimePoint at{};
};

// Why no motion begins under a lease any more.
struct LeaseEnding {
  enum class Why {
    released,
    expired,
    handed_over,
    taken_over,
    cut_off,        // the connection over which it was kept alive broke
    token_revoked,  // the bearer token of its holder
    restarted,      // the controller may have
  };
  Why why = Why::released;
  std::string who{};  // to whom it was handed over, or who took it over or revoked the token; empty: none of these
};
std::string_view name(LeaseEnding::Why why);     // "handed_over"
std::string text_of(const LeaseEnding& ending);  // "it was handed over to unix bert"

struct Lease {
  LeaseToken token = 0;
  std::string sealed_token;  // for the holder alone
  std::string holder;
  LeaseTerms terms;
  TimePoint since{}, expires{};
  std::optional<LeaseEnding> ending;  // nothing while it is held
  std::optional<Latch> latch;
};

struct WaitingLease {
  std::uint64_t id = 0;  // 0 is none
  std::string holder;    // to be
  LeaseTerms terms;
  TimePoint since{};
  int place = 1;                          // counts from 1
  std::optional<Duration> expected_wait;  // nothing where somebody in front has not said how long
};

struct LeaseGranted {
  LeaseToken lease = 0;
  std::string holder;
  LeaseTerms terms;
  bool by_take_over = false;
};

// No motion begins under it any more. One that runs may last longer.
struct LeaseEnded {
  LeaseToken lease = 0;
  std::string holder;
  AxisSet axes;
  LeaseEnding::Why why = LeaseEnding::Why::released;
};

// A stop holds this caller back.
struct Latched {
  std::string who;
  AxisSet axes;
};

// This caller may move the axes again.
struct Rearmed {
  std::string who;
  AxisSet axes;
};

using LeaseEvent = std::variant<LeaseGranted, LeaseEnded, Latched, Rearmed>;

}  // namespace axisgate::server
