#include "server/front/spending.h"

#include <algorithm>
#include <chrono>

#include "server/limits.h"

namespace axisgate::front {
Spending::Spending(const FrontLimits& limits, Sources& sources, const std::string& source, TimePoint now)
    : sources_(sources),
      source_(sources.of(source, now)),
      own_(limits.connection, now),
      guaranteed_(limits.guaranteed, now),
      stranger_(limits.stranger, now) {}

void Spending::admit(const std::string& caller, TimePoint now) {
  admitted_ = true;
  if (caller.empty() || caller == caller_) return;
  caller_ = caller;
  caller_elsewhere_ = sources_.of(caller_, now);
}

// Charges all connections of the source and all of the caller; returns the longer debt.
Duration Spending::debt_of_others(Cost cost, double tokens, TimePoint now) {
  const Duration of_source = source_->frames.take(cost, tokens, now);
  return caller_elsewhere_ ? std::max(of_source, caller_elsewhere_->frames.take(cost, tokens, now)) : of_source;
}

bool Spending::spend(Cost cost, double tokens, TimePoint now) {
  Duration debt = own_.take(cost, tokens, now);
  if (!admitted_) debt = std::max(debt, stranger_.take(cost, tokens, now));
  const Duration of_others = debt_of_others(cost, tokens, now);
  if (of_others > debt && !guaranteed_.take_if_there(cost, tokens, now)) debt = of_others;
  if (debt <= Duration::zero()) return true;
  const bool may_wait = cost == Cost::stream || cost == Cost::header_bytes || cost == Cost::unpacked ||
                        (cost == Cost::refusal && debt < server::kRefusalsWaitMax);
  if (may_wait) not_before_ = std::max(not_before_, now + debt);
  return may_wait;
}

}  // namespace axisgate::front
