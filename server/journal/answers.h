// Text form of a request's answer, which outlives the daemon.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/motion.h"
#include "device/stage/requests.h"

namespace axisgate::server::journal {

// The text contains names and messages, so it belongs in the memory of requests and not in the chain.
std::string answer_of(const stage::Motion& motion);
std::string answer_of(const Problem& problem);
std::string answer_of(const std::vector<stage::ExecuteEvent>& events);
// Answers with the numbers of the jobs.
std::string answer_of(const std::vector<std::uint64_t>& jobs);
// Answer of a request that succeeded and returns no data.
std::string answer_done();

// Reports whether a failure with this reason is decided before anything is sent.
bool is_refusal(Reason reason);

// Returns nullopt if the text is not a motion.
std::optional<stage::Motion> motion_in(std::string_view answer);
// Returns an empty vector if the text has no events.
std::vector<stage::ExecuteEvent> events_in(std::string_view answer);
// Returns an empty vector if the text has no jobs.
std::vector<std::uint64_t> jobs_in(std::string_view answer);
// Returns nullopt if the text is not a problem.
std::optional<Problem> problem_in(std::string_view answer);

}  // namespace axisgate::server::journal
