// Record of a job as JSON, as its file has it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/spool/job.h"

namespace axisgate::server::spool {

// Replaces invalid UTF-8 by U+FFFD.
std::string record_text(const Job& job);

// Returns nullopt if record_text() cannot have written the text.
std::optional<Job> job_in(std::string_view record);

}  // namespace axisgate::server::spool
