// A job of a mill: what it is, what it needs set up at the mill, and its states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "device/jobs/extent.h"
#include "device/jobs/leaves.h"
#include "device/jobs/place.h"
#include "device/jobs/run_on.h"
#include "device/jobs/send_settings.h"
#include "device/jobs/stock.h"
#include "device/jobs/time_range.h"

namespace axisgate::jobs {

using JobNumber = std::uint64_t;  // of one mill; 0: none

// A JobSetup is what a person sets up at the mill for a job. A confirmation counts for exactly this.
struct JobSetup {
  std::string digest;   // of its bytes: PreparedJob::digest()
  std::string profile;  // its name
  std::string origin;   // the name of a configured origin; empty: as it is set at the panel
  std::string tool;     // a configured name; of a job in parts, that of Job::part
  // Settings of the job before that no command can undo, as text: left_by(). Only the first job that waits has them,
  // and not between its parts.
  std::vector<std::string> left{};
  // Place where it continues, in its file or that of the part; nullopt if it begins at its beginning.
  std::optional<Place> from{};

  friend bool operator==(const JobSetup&, const JobSetup&) = default;
};

// One file of a job, sent as a job in itself. Between two of them somebody changes the tool.
struct JobPart {
  std::string tool;       // a configured name
  std::uint64_t end = 0;  // byte of the job after its last byte
  TimeRange takes{};      // when it is sent; the rest alone, where it is continued
  RunOn run_on{};         // likewise

  friend bool operator==(const JobPart&, const JobPart&) = default;
};
inline constexpr std::size_t kPartsAtMost = 16;

// README.md has the table of what leads from one to another.
enum class JobState {
  queued,
  confirmed,
  running,
  fed,
  done,
  aborted,
  paused_unknown,
  cancelled,
  tool_change,
  paused,
  expired  // last: kJobStates
};
inline constexpr std::size_t kJobStates = static_cast<std::size_t>(JobState::expired) + 1;
std::string_view name(JobState state);  // "QUEUED" ...
std::optional<JobState> job_state_named(std::string_view name);
bool is_end(JobState state);

enum class JobEvent {
  confirm,
  make_void,        // of the first part
  make_void_later,  // of a later one
  make_void_rest,   // of one that is continued
  start,
  raised,
  choose_rest,  // the place from which it is continued
  part_fed,     // and there is another one
  fed,
  aborted,
  abort_unsure,  // the mill may have dropped the abort
  lost,
  done,
  cancel,
  expire  // last: kJobEvents
};
inline constexpr std::size_t kJobEvents = static_cast<std::size_t>(JobEvent::expire) + 1;
std::string_view name(JobEvent event);  // "confirm", as in README.md
// Returns the state after the event; nullopt if the table has none.
std::optional<JobState> next(JobState state, JobEvent event);

// A range of what was written, in bytes of the job.
struct WrittenRange {
  std::uint64_t least = 0, most = 0;

  friend bool operator==(const WrittenRange&, const WrittenRange&) = default;
};

struct Confirmation {
  std::string by;     // the caller at the mill
  TimePoint until{};  // exclusive
};

struct Job {
  JobNumber number = 0;
  std::string name{};  // a person's text
  std::string owner{};
  JobSetup setup{};
  std::uint64_t bytes = 0;
  JobState state = JobState::queued;
  std::optional<Confirmation> confirmation{};  // while it is confirmed
  std::string void_because{};             // why its last confirmation does not count; empty: it does, or there was none
  std::optional<WrittenRange> written{};  // of one that was lost or paused, until it continues
  std::optional<PlaceRange> executed{};   // PreparedJob::executed() of one whose abort was requested
  std::vector<JobPart> parts{};           // at most kPartsAtMost; none: all of it is one, and its time is not known
  std::size_t part = 0;                   // runs, or is the next to
  Leaves leaves{};                        // of all parts
  Extent extent{};                        // of all parts
  std::vector<std::string> accepted{};    // names of the warnings of its check that its sender accepts
  std::int64_t rank = 0;                  // as is_before() has it; 0 as it was sent
  std::optional<Streaming> streaming{};   // none: as the mill has it
  std::optional<Stock> stock{};           // none: nobody has said it
  JobNumber continues = 0;                // the job whose workpiece it continues; 0: the workpiece is new
  std::uint64_t surfaces = 0;             // MillController::surfaces() when it was started last
  std::string checked_for{};              // a digest of the profile and the origin with which it was checked
  std::string planned_for{};              // a text of the settings with which its times were computed
  TimePoint queued_since{};               // when it was sent, or when its last confirmation became void
};

// Reports whether `one` is before `other` in the queue: jobs that were begun or are confirmed are before those that are
// QUEUED; then the lower rank counts; then the lower number.
bool is_before(const Job& one, const Job& other);

// Bytes of the job: where Job::part begins and ends.
std::uint64_t part_begin(const Job& job);
std::uint64_t part_end(const Job& job);
bool is_last_part(const Job& job);
// The byte of the job with which its part continues.
std::uint64_t next_byte(const Job& job);
// Another part is the next, with its tool, from its beginning.
void go_to_part(Job& job, std::size_t part);
// Reports whether the job can be confirmed, or is.
bool is_waiting(const Job& job);
// Reports whether the job waits and nothing of it was sent: no workpiece of it is in the mill.
bool waits_to_begin(const Job& job);
// Returns the time to send and execute its part and all later parts, without the time of people between them.
TimeRange takes(const Job& job);
// Returns the time of the later parts alone.
TimeRange takes_later(const Job& job);
// Returns what runs on after an abort of its part; nothing where that has not been planned.
std::optional<RunOn> run_on(const Job& job);
// Sets both for its part.
void set_plan(Job& job, const TimeRange& takes, const RunOn& run_on);
// Reports whether it is the rest of another job (MillController::add()), and nothing of it was sent.
bool is_fresh_rest(const Job& job);
// Returns the event of a confirmation that becomes void.
JobEvent void_event(const Job& job);

// "job 7 (part.rml) sets Z0": what the jobs after it find, for people.
std::vector<std::string> left_by(const Job& job);

// "by the mill's profile what was executed ends between line 8, column 1 and line 13, column 1".
std::string executed_text(const Job& job);

// "job 7 (part.rml, by unix anna)".
std::string text_of(const Job& job);

}  // namespace axisgate::jobs
