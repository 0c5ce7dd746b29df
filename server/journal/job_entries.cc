#include "server/journal/job_entries.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "server/journal/body.h"

namespace axisgate::server::journal {

Entry entry_of(const jobs::Job& job, std::string_view by, std::string_view why, std::string device, TimePoint now) {
  nlohmann::json body{{"job", job.number},          {"state", jobs::name(job.state)},
                      {"digest", job.setup.digest}, {"profile", job.setup.profile},
                      {"origin", job.setup.origin}, {"tool", job.setup.tool}};
  if (job.setup.from) body["from_line"] = job.setup.from->line;
  if (job.written) body["sent"] = {job.written->least, job.written->most};
  if (!why.empty()) body["why"] = std::string(why);
  return entry_of({EntryKind::job_changed, std::move(body), std::string(by)}, std::move(device), now);
}

}  // namespace axisgate::server::journal
