// Journal entries for the jobs of a mill.
#pragma once

#include <string>
#include <string_view>

#include "device/jobs/job.h"
#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Omits the job's name, which is a person's text. `by`: the caller who requested the change; empty: none. `why`: reason
// as text for people; may be empty.
Entry entry_of(const jobs::Job& job, std::string_view by, std::string_view why, std::string device, TimePoint now);

}  // namespace axisgate::server::journal
