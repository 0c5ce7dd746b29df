// What is known of a job, as its file has it: JSON.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/spool/job.h"

namespace axisgate::server::spool {

// What is no UTF-8 becomes U+FFFD.
std::string record_text(const Job& job);

// Nothing, where the text is none that record_text() writes.
std::optional<Job> job_in(std::string_view record);

}  // namespace axisgate::server::spool
