// Rate limits of one connection, and of all connections of one source together.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "device/core/time.h"

namespace axisgate::front {

enum class Cost {
  stream,        // a call that begins
  header_bytes,  // of a call's headers, as sent or as counted in a header list, whichever is more
  reset,         // a call that its caller cancels
  control,       // PING, WINDOW_UPDATE, PRIORITY, empty DATA, acknowledgements, unknown frames, frames of no call
  settings,      // SETTINGS
  refusal,       // a call that was refused for lack of a right, or that breaks the rules of HTTP/2
  unpacked,      // bytes of unpacked messages
};
inline constexpr std::size_t kCosts = 7;

// Rate of one token bucket, which fills by `per_second` up to `burst`.
struct Rate {
  double per_second = 0;
  double burst = 0;
};
using Rates = std::array<Rate, kCosts>;  // by Cost

// Not thread safe.
class TokenBucket {
 public:
  TokenBucket(Rate rate, TimePoint now) : rate_(rate), tokens_(rate.burst), at_(now) {}

  // Takes the tokens; the bucket may go into debt.
  void take(double tokens, TimePoint now);
  // Takes the tokens only if the bucket has them; reports whether it had.
  bool take_if_there(double tokens, TimePoint now);
  // Time until the debt is paid; zero without a debt.
  Duration debt() const;
  bool full(TimePoint now);

 private:
  void fill(TimePoint now);

  Rate rate_;
  double tokens_;
  TimePoint at_;
};

// A Budget has one bucket for each cost.
class Budget {
 public:
  Budget(const Rates& rates, TimePoint now);

  Duration take(Cost cost, double tokens, TimePoint now);  // returns the debt after taking
  bool take_if_there(Cost cost, double tokens, TimePoint now);
  bool full(TimePoint now);

 private:
  std::array<TokenBucket, kCosts> buckets_;
};

// A Source is a user or an address, over all its connections.
struct Source {
  Budget frames;
  TokenBucket connections, handshakes;  // new ones
};

struct SourceRates {
  Rates frames;
  Rate connections, handshakes;
};

// Not thread safe.
class Sources {
 public:
  explicit Sources(const SourceRates& rates) : rates_(rates) {}

  std::shared_ptr<Source> of(const std::string& source, TimePoint now);
  // Removes the sources that nobody uses and whose buckets are full.
  void forget_idle(TimePoint now);
  std::size_t size() const { return sources_.size(); }

 private:
  const SourceRates rates_;
  std::map<std::string, std::shared_ptr<Source>> sources_;
};

}  // namespace axisgate::front
