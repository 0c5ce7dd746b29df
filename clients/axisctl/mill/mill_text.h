// Texts about mills and their jobs. A mill never replies, so the amounts it has executed, and still runs, are ranges.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "axisgate/v1/event.pb.h"
#include "axisgate/v1/mill.pb.h"

namespace axisgate::axisctl {

// Returns null if the mill has no such job.
const v1::Job* find_job(const v1::Mill& mill, std::string_view name);

// Returns "job 7 (part.rml)".
std::string job_text(const v1::Job& job);

// Returns "job 7 (part.rml) QUEUED; takes 12 min 0 s to 18 min 30 s, paced; 38.0 x 30.0 mm, 1.70 mm deep; after an
// abort at most 64 bytes ... run on".
std::string state_text(const v1::Job& job);

// Returns "job 7 (part.rml) RUNNING: FINISHING", "job 7 (part.rml) PAUSED", "job 7 (part.rml) ABORTED, by unix anna:
// the abort was sent".
std::string change_text(const v1::JobChange& change);

// Returns the place where a PAUSED job continues, and the preparations for it.
std::string rest_text(const v1::Job& job);

// Returns "job 7 (part.rml) is confirmed by unix anna until 2026-11-21 16:10:00+01:00".
std::string confirmed_text(const v1::Job& job);

// Returns "after an abort at most 64 bytes, up to 3.2 s, run on, at most 2048 if the panel holds the mill (VIEW, an
// open cover)".
std::string run_on_text(const v1::RunOn& run_on);

// Returns "SENDING [====-     ] 41 to 44 %, 15000 of 30000 bytes written, 14488 taken, 5 min 36 s to 9 min 50 s left".
// In the bar `=` is executed and `-` may be executed. The mill has taken at least the bytes that are called taken. The
// time left is the job's duration in the ratio of the bytes not yet executed.
std::string progress_text(const v1::Job& job, const v1::RunningJob& running);

inline constexpr std::string_view kBusyText = "the mill is busy: look at it";

// Returns "job 7 is paused: 10 to 64 bytes of it, up to 3.2 s, still run, ...; the cutter keeps turning in the cut".
std::string paused_text(const v1::RunningJob& running);

// Returns "the abort was sent: at most 64 bytes of job 7, up to 3.2 s, may run on; by the mill's profile what is
// executed ends between line 8, column 1 and line 13, column 1; look at the mill; ...". The text never says that
// anything has stopped.
std::string aborted_text(const v1::AbortJobResponse& response);

// Returns "by the mill's profile what was executed ends between line 8, column 1 and line 13, column 1". The job must
// have Job.executed.
std::string executed_text(const v1::Job& job);
// Returns the command that draws the rest of the job. The job must have Job.executed.
std::string remains_text(const v1::Job& job);

// Text for a mill that runs no job: the job that waits, and the reason. "no job runs; job 7 (frame.rml) waits for ...".
std::string waiting_text(const v1::Mill& mill);

// Returns a line about the mill, a line about the running job, lines about the measured pace and the last aborted job,
// if any, and the queue as a table. The table says "at the earliest" for the start of a job, because people must
// confirm in between.
std::vector<std::string> queue_lines(const v1::Mill& mill);

// Returns the setup of the job, for the person at the mill, one item a line.
std::vector<std::string> setup_lines(const v1::Job& job);

// Returns "The material is in, the tool T1 is in, the origin is set, and nothing is in the way? [yes/no]". Before a
// later part: "The tool T3 is in, Z0 is set, and nothing is in the way? [yes/no]".
std::string setup_question(const v1::Job& job);

}  // namespace axisgate::axisctl
