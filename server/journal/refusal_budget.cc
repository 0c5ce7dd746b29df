#include "server/journal/refusal_budget.h"

#include <nlohmann/json.hpp>

#include "server/access/access.h"
#include "server/journal/body.h"

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;

Entry sum_of(Entry last, std::int64_t count) {
  Json body = Json::parse(last.body, nullptr, false);
  body["count"] = count;
  last.body = json_text(body);
  return last;
}

}  // namespace

std::vector<Entry> RefusalBudget::add(Entry refusal, TimePoint now) {
  std::vector<Entry> wanted = due(now);
  const std::string identity = identity_of(refusal.who);
  if (!identities_.contains(identity)) {
    if (identities_.size() == kIdentitiesMax) end_oldest(wanted);
    began_.emplace_back(now, identity);
  }
  Refused& refused = identities_[identity];
  if (++refused.count <= kEntries) {
    wanted.push_back(std::move(refusal));
  } else {
    refused.last = std::move(refusal);
  }
  return wanted;
}

std::vector<Entry> RefusalBudget::due(TimePoint now) {
  std::vector<Entry> sums;
  while (!began_.empty() && now - began_.front().first >= kRefusalPeriod) end_oldest(sums);
  return sums;
}

std::vector<Entry> RefusalBudget::rest() {
  std::vector<Entry> sums;
  while (!began_.empty()) end_oldest(sums);
  return sums;
}

void RefusalBudget::end_oldest(std::vector<Entry>& sums) {
  const auto oldest = identities_.extract(began_.front().second);
  began_.pop_front();
  const std::int64_t beyond = oldest.mapped().count - kEntries;
  if (beyond > 0) sums.push_back(sum_of(std::move(oldest.mapped().last), beyond));
}

std::optional<TimePoint> RefusalBudget::next_due() const {
  return began_.empty() ? std::nullopt : std::optional(began_.front().first + kRefusalPeriod);
}

}  // namespace axisgate::server::journal
