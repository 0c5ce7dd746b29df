// What the journal keeps of the jobs of a mill.
#pragma once

#include <string>
#include <string_view>

#include "device/rml1/mill/job.h"
#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Without the job's name, which is text of a person. `by`: who requested it; empty: nobody. `why`: for people; may be
// empty.
Entry entry_of(const rml1::Job& job, std::string_view by, std::string_view why, std::string device, TimePoint now);

}  // namespace axisgate::server::journal
