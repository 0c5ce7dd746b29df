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

bool Budget::full(TimePoint now) {
  return std::ranges::all_of(buckets_, [now](TokenBucket& bucket) { return bucket.full(now); });
}

std::shared_ptr<Budget> SourceBudgets::of(const std::string& source, TimePoint now) {
  std::shared_ptr<Budget>& budget = sources_[source];
  if (!budget) budget = std::make_shared<Budget>(rates_, now);
  return budget;
}

void SourceBudgets::forget_idle(TimePoint now) {
  std::erase_if(sources_,
                [now](const auto& entry) { return entry.second.use_count() == 1 && entry.second->full(now); });
}

}  // namespace axisgate::front
