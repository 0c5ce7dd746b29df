// The jobs of a mill, as they stand in the spool: bytes, and what they need set up at the mill.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/mill/job.h"
#include "device/rml1/mill/prepared_job.h"
#include "server/config/config.h"
#include "server/devices/job_record.h"
#include "server/spool/spool.h"

namespace axisgate::server {

// What the spool keeps beside the bytes, as JSON. Without what the spool knows, such as the digest.
std::string facts_of(const rml1::Job& job);
// QUEUED since it was sent, in the TOOL_CHANGE before a later part, or PAUSED in a part.
rml1::Job job_of(const spool::Job& spooled);

// Those that have not ended, in the order of their numbers.
std::vector<rml1::Job> unended_jobs(const spool::Spool& spool, const std::string& device);
// As the run before left a job that it had begun to send.
rml1::Job as_it_was_left(rml1::Job job, const LastJob& last);
// So that a run after this one knows where it continues and its place in the queue. What goes wrong is in the log.
void keep_facts(spool::Spool& spool, const std::string& device, const rml1::Job& job);
// Keeps the job, as it ended, for some time more. What goes wrong is in the log: the job then comes back with the next
// run, QUEUED.
void end_spooled(spool::Spool& spool, const std::string& device, const rml1::Job& job);
// Returns a job that has ended, as it ended; ABORTED and CANCELLED ones with what is known to be executed. Fails with
// not_found if the spool no longer has it, and with wrong_mode if it has not ended.
Result<rml1::Job> ended_job(const spool::Spool& spool, const std::string& device, rml1::JobNumber number);

// The work origin as the check of a job takes it. Without a height of its own, Z0 is where the profile has it.
rml1::Origin origin_of(const NamedOrigin& named, const rml1::Profile& profile);

// A digest of the profile and of where that origin is: what a job is checked for.
std::string checked_for(const MillConfig& config, const std::string& origin);
// A text of how the jobs of that mill are sent: what the times of a job were computed for.
std::string planned_for(const MillConfig& config);

// Those below read the whole job, so not on the device's strand. not_found; internal, where the bytes are others than
// they were; and what is said there.

// As it was published, its part, from the place where it continues: what rml1::approach_to() refuses.
// `measured`: of the mill.
Result<std::shared_ptr<const rml1::PreparedJob>> prepared_job(const spool::Spool& spool, const std::string& device,
                                                              const MillConfig& config, const rml1::Job& job,
                                                              const std::optional<rml1::MeasuredPace>& measured);
// Computes the time of its part and of those behind it, and what runs on after an abort, and keeps both in the spool.
Result<void> plan_job(spool::Spool& spool, const std::string& device, const MillConfig& config, rml1::Job& job,
                      const std::optional<rml1::MeasuredPace>& measured);
// Where the part of `job` continues, with its first command from that line and column on. What rml1::approach_to() and
// rml1::check_continued() refuse; invalid_request, with line 0: it says where what was sent ends.
Result<rml1::Place> chosen_rest(const spool::Spool& spool, const std::string& device, const MillConfig& config,
                                const rml1::Job& job, std::uint64_t line, std::uint64_t column);

}  // namespace axisgate::server
