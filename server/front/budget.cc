#include "server/front/budget.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace axisgate::front {
namespace {

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

template <std::size_t... kIndex>
std::array<TokenBucket, kCosts> full_buckets(const Rates& rates, TimePoint now, std::index_sequence<kIndex...>) {
  return {TokenBucket(rates[kIndex], now)...};
}

}  // namespace

void TokenBucket::fill(TimePoint now) {
  if (now > at_) tokens_ = std::min(rate_.burst, tokens_ + seconds(now - at_) * rate_.per_second);
  at_ = std::max(at_, now);
}

void TokenBucket::take(double tokens, TimePoint now) {
  fill(now);
  tokens_ -= tokens;
}

bool TokenBucket::take_if_there(double tokens, TimePoint now) {
  fill(now);
  if (tokens_ < tokens) return false;
  tokens_ -= tokens;
  return true;
}

Duration TokenBucket::debt() const {
  if (tokens_ >= 0) return {};
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(-tokens_ / rate_.per_second));
}

bool TokenBucket::full(TimePoint now) {
  fill(now);
  return tokens_ >= rate_.burst;
}

Budget::Budget(const Rates& rates, TimePoint now)
    : buckets_(full_buckets(rates, now, std::make_index_sequence<kCosts>())) {}

Duration Budget::take(Cost cost, double tokens, TimePoint now) {
  TokenBucket& bucket = buckets_[static_cast<std::size_t>(cost)];
  bucket.take(tokens, now);
  return bucket.debt();
}

bool Budget::take_if_there(Cost cost, double tokens, TimePoint now) {
  return buckets_[static_cast<std::size_t>(cost)].take_if_there(tokens, now);
}

bool Budget::full(TimePoint now) {
  return std::ranges::all_of(buckets_, [now](TokenBucket& bucket) { return bucket.full(now); });
}

std::shared_ptr<Source> Sources::of(const std::string& source, TimePoint now) {
  std::shared_ptr<Source>& known = sources_[source];
  if (!known) {
    known = std::make_shared<Source>(Source{.frames = Budget(rates_.frames, now),
                                            .connections = TokenBucket(rates_.connections, now),
                                            .handshakes = TokenBucket(rates_.handshakes, now)});
  }
  return known;
}

void Sources::forget_idle(TimePoint now) {
  std::erase_if(sources_, [now](const auto& entry) {
    Source& source = *entry.second;
    return entry.second.use_count() == 1 && source.frames.full(now) && source.connections.full(now) &&
           source.handshakes.full(now);
  });
}

}  // namespace axisgate::front
