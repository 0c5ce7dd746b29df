// What the journal keeps of the jobs of a mill.
#pragma once

#include <string>

#include "device/rml1/mill/job.h"
#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Without the job's name, which is text of a person.
Entry entry_of(const rml1::Job& job, std::string device, TimePoint now);

}  // namespace axisgate::server::journal
