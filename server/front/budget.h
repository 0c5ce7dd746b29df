// How much a connection, and all connections of one source together, may ask of the daemon a second.
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
  header_bytes,  // of its headers, as they were sent, or as a list has them, if that is more
  reset,         // a call that its caller breaks off
  control,       // PING, WINDOW_UPDATE, PRIORITY, empty DATA, acknowledgements, unknown frames, those of no call
  settings,      // SETTINGS
  refusal,       // a call that was refused for want of a right, or that is against the rules of HTTP/2
  unpacked,      // bytes of messages that were compressed
};
inline constexpr std::size_t kCosts = 7;

// Filled by `per_second` up to `burst`.
struct Rate {
  double per_second = 0;
  double burst = 0;
};
using Rates = std::array<Rate, kCosts>;  // by Cost

// Not thread safe.
class TokenBucket {
 public:
  TokenBucket(Rate rate, TimePoint now) : rate_(rate), tokens_(rate.burst), at_(now) {}

  // Takes them, also where they are not there yet.
  void take(double tokens, TimePoint now);
  // Takes them where they are there.
  bool take_if_there(double tokens, TimePoint now);
  // Until what was taken is there: zero, where it is.
  Duration debt() const;
  bool full(TimePoint now);

 private:
  void fill(TimePoint now);

  Rate rate_;
  double tokens_;
  TimePoint at_;
};

// One bucket for each cost.
class Budget {
 public:
  Budget(const Rates& rates, TimePoint now);

  Duration take(Cost cost, double tokens, TimePoint now);  // the debt afterwards
  bool take_if_there(Cost cost, double tokens, TimePoint now);
  bool full(TimePoint now);

 private:
  std::array<TokenBucket, kCosts> buckets_;
};

// A user or an address, over all its connections.
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
  // Those that nobody has any more, and that are full.
  void forget_idle(TimePoint now);
  std::size_t size() const { return sources_.size(); }

 private:
  const SourceRates rates_;
  std::map<std::string, std::shared_ptr<Source>> sources_;
};

}  // namespace axisgate::front
