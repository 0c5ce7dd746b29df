#include "server/spool/record.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "server/spool/job_name.h"

namespace axisgate::server::spool {
namespace {

using Json = nlohmann::json;
using std::chrono::sys_seconds;

constexpr std::uint64_t kLatest = 253'402'300'799;  // 9999-12-31; leaves room for adding and subtracting times

// Returns a whole number that is not negative. Throws as nlohmann's own functions do for any other value.
std::uint64_t count_in(const Json& value) { return value.get_ref<const Json::number_unsigned_t&>(); }

sys_seconds time_in(const Json& value) { return sys_seconds(std::chrono::seconds(std::min(count_in(value), kLatest))); }

Job read(const Json& json) {
  Job job{.id = count_in(json.at("id")),
          .name = json.at("name"),
          .who = json.at("who"),
          .identity = json.at("identity"),
          .bytes = static_cast<std::int64_t>(count_in(json.at("bytes"))),
          .sha256 = json.at("sha256"),
          .created = time_in(json.at("created")),
          .facts = json.at("facts")};
  if (json.contains("ended")) job.ended = time_in(json.at("ended"));
  return job;
}

}  // namespace

std::string record_text(const Job& job) {
  Json json{{"id", job.id},
            {"name", job.name},
            {"who", job.who},
            {"identity", job.identity},
            {"bytes", job.bytes},
            {"sha256", job.sha256},
            {"created", job.created.time_since_epoch().count()},
            {"facts", job.facts}};
  if (job.ended) json["ended"] = job.ended->time_since_epoch().count();
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::optional<Job> job_in(std::string_view record) {
  try {
    Job job = read(Json::parse(record));
    const Result<std::string> name = job_name(job.name);
    if (!name || *name != job.name) return std::nullopt;
    return job;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace axisgate::server::spool
