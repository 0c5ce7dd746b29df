#include "server/config/journal.h"

#include <span>

#include "server/config/words.h"

namespace axisgate::server {
namespace {

// A segment (journal::Store::kSegment) takes several megabytes.
constexpr int kDaysMax = 36'600, kMegabytesMin = 16, kMegabytesMax = 1'000'000;
constexpr int kHoursMax = 24 * 366, kRequestsMax = 1'000'000;

}  // namespace

void read_journal(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                  JournalConfig& journal) {
  ConfigTable table(source, "journal", file, errors);
  journal.kept = table.flag("kept").value_or(journal.kept);
  if (const auto act = table.choice<bool>("unavailable", kUnavailable)) journal.act_without = *act;
  if (const auto days = table.integer("days", 1, kDaysMax)) journal.days = static_cast<int>(*days);
  if (const auto size = table.integer("megabytes", kMegabytesMin, kMegabytesMax)) {
    journal.megabytes = static_cast<int>(*size);
  }
  if (const auto hours = table.integer("remember_hours", 1, kHoursMax)) {
    journal.remember_hours = static_cast<int>(*hours);
  }
  if (const auto requests = table.integer("remember_requests", 1, kRequestsMax)) {
    journal.remember_requests = static_cast<int>(*requests);
  }
  const auto roles = std::span(kRoles).subspan(1);  // "nobody" may read nothing
  journal.others_seen_by = table.choice<Role>("others_seen_by", roles).value_or(journal.others_seen_by);
  table.refuse_unknown();
}

}  // namespace axisgate::server
