// What a request was answered, as text that outlives the daemon.
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

// With names and messages, so that it is for the memory of requests, and not for the chain.
std::string answer_of(const stage::Motion& motion);
std::string answer_of(const Problem& problem);
std::string answer_of(const std::vector<stage::ExecuteEvent>& events);
// Of jobs by their numbers.
std::string answer_of(const std::vector<std::uint64_t>& jobs);
// Of one that was done, and answered nothing.
std::string answer_done();

// Whether it is decided before anything is sent.
bool is_refusal(Reason reason);

// Nothing, where the text is no motion.
std::optional<stage::Motion> motion_in(std::string_view answer);
// None, where the text has none.
std::vector<stage::ExecuteEvent> events_in(std::string_view answer);
// None, where the text has none.
std::vector<std::uint64_t> jobs_in(std::string_view answer);
// Nothing, where the text is no problem.
std::optional<Problem> problem_in(std::string_view answer);

}  // namespace axisgate::server::journal
