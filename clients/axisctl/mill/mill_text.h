// What is said about mills and their jobs. What a mill has executed, and what still runs, is a range: it never answers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "axisgate/v1/event.pb.h"
#include "axisgate/v1/mill.pb.h"

namespace axisgate::axisctl {

// Nothing where the mill has no such job.
const v1::Job* find_job(const v1::Mill& mill, std::string_view name);

// "job 7 (part.rml)".
std::string job_text(const v1::Job& job);

// "job 7 (part.rml) QUEUED; takes 12 min 0 s to 18 min 30 s, paced; 38.0 x 30.0 mm, 1.70 mm deep; after an abort at
// most 64 bytes ... run on".
std::string state_text(const v1::Job& job);

// "job 7 (part.rml) RUNNING: FINISHING", "job 7 (part.rml) PAUSED", "job 7 (part.rml) ABORTED, by unix anna: the abort
// was sent".
std::string change_text(const v1::JobChange& change);

// Of a job that is PAUSED: where it continues, and what is to be done before.
std::string rest_text(const v1::Job& job);

// "job 7 (part.rml) is confirmed by unix anna until 2026-11-21 16:10:00".
std::string confirmed_text(const v1::Job& job);

// "after an abort at most 64 bytes, up to 3.2 s, run on, at most 2048 if the panel holds the mill (VIEW, an open
// cover)".
std::string run_on_text(const v1::RunOn& run_on);

// "SENDING [====-     ] 41 to 44 %, 15000 of 30000 bytes written, 14488 taken, 5 min 36 s to 9 min 50 s left". In the
// bar `=` is executed and `-` may be. At least so many bytes are taken by the mill. The time left is the job's, in the
// ratio of the bytes not yet executed.
std::string progress_text(const v1::Job& job, const v1::RunningJob& running);

inline constexpr std::string_view kBusyText = "the mill is busy: look at it";

// "job 7 is paused: 10 to 64 bytes of it, up to 3.2 s, still run, ...; the cutter keeps turning in the cut".
std::string paused_text(const v1::RunningJob& running);

// "the abort was sent: at most 64 bytes of job 7, up to 3.2 s, may run on; by the mill's profile what is executed ends
// between line 8, column 1 and line 13, column 1; look at the mill". Never that anything has stopped.
std::string aborted_text(const v1::AbortJobResponse& response);

// Of a job that has Job.executed: "by the mill's profile what was executed ends between line 8, column 1 and line 13,
// column 1".
std::string executed_text(const v1::Job& job);
// Which command draws the rest of it.
std::string remains_text(const v1::Job& job);

// Text for a mill that runs no job: which job waits, and for what. "no job runs; job 7 (frame.rml) waits for ...".
std::string waiting_text(const v1::Mill& mill);

// The mill in one line, what runs in another, its measured pace and what was aborted last where there are such, and the
// queue as a table. When a job begins is said "at the earliest", since people confirm between.
std::vector<std::string> queue_lines(const v1::Mill& mill);

// What a person sets up for the job, a line each.
std::vector<std::string> setup_lines(const v1::Job& job);

// "The material is in, the tool T1 is in, the origin is set, and nothing is in the way? [yes/no]", or, before a later
// part, "The tool T3 is in, Z0 is set, and nothing is in the way? [yes/no]".
std::string setup_question(const v1::Job& job);

}  // namespace axisgate::axisctl
