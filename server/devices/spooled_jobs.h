// Jobs of a mill as the spool keeps them: bytes, and the setup that they need at the mill.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/jobs/job.h"
#include "device/jobs/machine.h"
#include "server/config/config.h"
#include "server/devices/job_record.h"
#include "server/spool/spool.h"

namespace axisgate::server {

// Returns the data that the spool keeps with the bytes, as JSON. Omits what the spool knows itself, such as the digest.
std::string facts_of(const jobs::Job& job);
// Returns a job that is QUEUED since it was sent, in TOOL_CHANGE before a later part, or PAUSED in a part.
jobs::Job job_of(const spool::Job& spooled);

// Returns the jobs that have not ended, in the order of their numbers.
std::vector<jobs::Job> unended_jobs(const spool::Spool& spool, const std::string& device);
// Returns a job whose sending the previous run had begun, in the state in which that run left it.
jobs::Job as_it_was_left(jobs::Job job, const LastJob& last);
// Keeps the job's place in the queue and the place where it continues, for the next run. Failures are logged.
void keep_facts(spool::Spool& spool, const std::string& device, const jobs::Job& job);
// Keeps the ended job for some more time. Failures are logged; the job then returns as QUEUED in the next run.
void end_spooled(spool::Spool& spool, const std::string& device, const jobs::Job& job);
// Returns a job that has ended, with its final state; ABORTED and CANCELLED jobs include the known range of executed
// bytes. Fails with not_found if the spool no longer has it, and with wrong_job_state if it has not ended.
Result<jobs::Job> ended_job(const spool::Spool& spool, const std::string& device, jobs::JobNumber number);

// Returns a digest of the profile and the origin's position, with which a job is checked.
std::string checked_for(const MillConfig& config, const std::string& origin);
// Returns the settings of sending as text; a job's times are computed for these settings.
std::string planned_for(const MillConfig& config);

// The functions below read the whole job, so they must not run on the device's strand. In addition to the errors named
// for each, they fail with not_found, or with internal if the bytes have changed.

// Returns the present part of the job as it was published, from the place where it continues. Fails with the errors of
// Model::prepare(). `measured`: pace of the mill.
Result<std::shared_ptr<const jobs::PreparedJob>> prepared_job(const spool::Spool& spool, const std::string& device,
                                                              const MillConfig& config, const jobs::Job& job,
                                                              const std::optional<jobs::MeasuredPace>& measured);
// Computes the durations of the present part and the later ones, and what runs on after an abort, and keeps both in the
// spool.
Result<void> plan_job(spool::Spool& spool, const std::string& device, const MillConfig& config, jobs::Job& job,
                      const std::optional<jobs::MeasuredPace>& measured);
// Returns the place where the part of `job` continues: its first command at or after the given line and column. Fails
// with the errors of Model::rest_from(). Fails with invalid_request if `line` is 0; the
// message says where the executed bytes end.
Result<jobs::Place> chosen_rest(const spool::Spool& spool, const std::string& device, const MillConfig& config,
                                const jobs::Job& job, std::uint64_t line, std::uint64_t column);

}  // namespace axisgate::server
