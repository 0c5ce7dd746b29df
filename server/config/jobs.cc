#include "server/config/jobs.h"

#include <fmt/format.h>

namespace axisgate::server {
namespace {

constexpr int kMegabytesAtMost = 1'000'000, kDaysAtMost = 36'600, kCountAtMost = 100'000, kConfirmDaysAtMost = 365;

void read_number(ConfigTable& table, std::string_view key, int most, int& into) {
  if (const auto value = table.integer(key, 1, most)) into = static_cast<int>(*value);
}

}  // namespace

void read_jobs(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors, JobsConfig& jobs) {
  ConfigTable table(source, "jobs", file, errors);
  read_number(table, "megabytes", kMegabytesAtMost, jobs.megabytes);
  read_number(table, "megabytes_each", kMegabytesAtMost, jobs.megabytes_each);
  read_number(table, "megabytes_per_person", kMegabytesAtMost, jobs.megabytes_per_person);
  read_number(table, "count", kCountAtMost, jobs.count);
  jobs.count_per_person = jobs.quarter();
  read_number(table, "count_per_person", kCountAtMost, jobs.count_per_person);
  read_number(table, "days", kDaysAtMost, jobs.days);
  read_number(table, "confirm_days", kConfirmDaysAtMost, jobs.confirm_days);
  for (const auto& [key, value] : {std::pair("megabytes_each", jobs.megabytes_each),
                                   std::pair("megabytes_per_person", jobs.megabytes_per_person)}) {
    if (value > jobs.megabytes && table.has(key)) {
      table.error(key,
                  fmt::format("{} is more than all jobs may have; use at most megabytes = {}", value, jobs.megabytes));
    }
  }
  if (jobs.megabytes_each > jobs.megabytes_per_person && table.has("megabytes_each")) {
    table.error("megabytes_each", fmt::format("{} is more than one person's jobs may have; use at most "
                                              "megabytes_per_person = {}",
                                              jobs.megabytes_each, jobs.megabytes_per_person));
  }
  if (jobs.count_per_person > jobs.quarter()) {
    table.error("count_per_person", fmt::format("{} is more than a quarter of count = {}; use at most {}",
                                                jobs.count_per_person, jobs.count, jobs.quarter()));
  }
  table.refuse_unknown();
}

}  // namespace axisgate::server
