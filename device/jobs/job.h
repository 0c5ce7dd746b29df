// A job of a mill: its data, the setup at the mill that it needs, and its states.
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

using JobNumber = std::uint64_t;  // numbers of each mill are separate; 0: no job

// A JobSetup describes how a person must set up the mill for a job. A confirmation is valid only for the same JobSetup.
struct JobSetup {
  std::string digest;   // digest of the job's bytes: PreparedJob::digest()
  std::string profile;  // name of the profile
  std::string origin;   // name of a configured origin; empty: set at the panel
  std::string tool;     // configured name of the tool; for a job in parts, the tool of Job::part
  // Settings of the previous job that no command can undo, as text: left_by(). Empty for all jobs except the first
  // waiting job, and empty if that job was begun before.
  std::vector<std::string> left{};
  // Place at which the job continues, in its file or in the file of its part; nullopt: at the beginning.
  std::optional<Place> from{};

  friend bool operator==(const JobSetup&, const JobSetup&) = default;
};

// A JobPart is one file of a job, and is sent like a whole job. The operator changes the tool between two parts.
struct JobPart {
  std::string tool;       // configured name of the tool
  std::uint64_t end = 0;  // offset in the job, just past the last byte of the part
  TimeRange takes{};      // time to send and execute the part, or only its rest if it continues in its middle
  RunOn run_on{};         // bound for the part, or only for its rest

  friend bool operator==(const JobPart&, const JobPart&) = default;
};
inline constexpr std::size_t kPartsAtMost = 16;

// States of a job. README.md has the table of states and events.
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
  expired  // must be the last value: kJobStates
};
inline constexpr std::size_t kJobStates = static_cast<std::size_t>(JobState::expired) + 1;
std::string_view name(JobState state);  // "QUEUED" ...
std::optional<JobState> job_state_named(std::string_view name);
bool is_end(JobState state);

enum class JobEvent {
  confirm,
  make_void,        // the confirmation is void; the job was not begun
  make_void_later,  // the confirmation is void; a later part is next
  make_void_rest,   // the confirmation is void; the rest of a begun part is next
  start,
  raised,       // paused, with the tool up
  choose_rest,  // the place at which the job continues was chosen
  part_fed,     // the mill has executed a part, and another part follows
  fed,
  aborted,
  abort_unsure,  // the abort was sent, but the mill may have dropped it
  lost,
  done,
  cancel,
  expire  // must be the last value: kJobEvents
};
inline constexpr std::size_t kJobEvents = static_cast<std::size_t>(JobEvent::expire) + 1;
std::string_view name(JobEvent event);  // "confirm", as in README.md
// Returns the state after the event; nullopt if the table does not allow the event.
std::optional<JobState> next(JobState state, JobEvent event);

// Number of written bytes of a job, as a range.
struct WrittenRange {
  std::uint64_t least = 0, most = 0;

  friend bool operator==(const WrittenRange&, const WrittenRange&) = default;
};

struct Confirmation {
  std::string by;     // caller who has confirmed the job at the mill
  TimePoint until{};  // end of the confirmation, exclusive
};

struct Job {
  JobNumber number = 0;
  std::string name{};  // text, chosen by a person
  std::string owner{};
  JobSetup setup{};
  std::uint64_t bytes = 0;
  JobState state = JobState::queued;
  std::optional<Confirmation> confirmation{};  // nullopt unless the job is CONFIRMED
  std::string void_because{};             // why the last confirmation is void; empty: it is valid, or there was none
  std::optional<WrittenRange> written{};  // set when the job is lost or paused, until it continues
  std::optional<PlaceRange> executed{};   // PreparedJob::executed() when an abort was requested; nullopt: no abort
  std::vector<JobPart> parts{};           // at most kPartsAtMost; empty: a single part, whose duration is unknown
  std::size_t part = 0;                   // index of the part that runs, or runs next
  Leaves leaves{};                        // of all parts
  Extent extent{};                        // of all parts
  std::vector<std::string> accepted{};    // names of the warnings that the sender of the job accepts
  std::int64_t rank = 0;                  // order in the queue, see is_before(); 0 for a new job
  std::optional<Streaming> streaming{};   // nullopt: as configured for the mill
  std::optional<Stock> stock{};           // nullopt: unknown
  JobNumber continues = 0;                // the job whose workpiece this job continues; 0: the workpiece is new
  std::uint64_t z0_count = 0;             // Machine::z0_count() at the last start; before a start, see Machine::add()
  std::string checked_for{};              // digest of the profile and the origin that the check used
  std::string planned_for{};              // settings with which the times were computed, as text
  TimePoint queued_since{};               // when the job was sent, or when its last confirmation became void
};

// Reports whether `one` is before `other` in the queue. Jobs that were begun or are confirmed are before QUEUED jobs.
// Otherwise the job with the lower rank comes first; with equal ranks, the job with the lower number.
bool is_before(const Job& one, const Job& other);

// Offsets in the job of the beginning and the end of Job::part.
std::uint64_t part_begin(const Job& job);
std::uint64_t part_end(const Job& job);
bool is_last_part(const Job& job);
// Offset in the job of the byte at which Job::part begins or continues.
std::uint64_t next_byte(const Job& job);
// Makes `part` the next part, with its tool, from its beginning.
void go_to_part(Job& job, std::size_t part);
// Reports whether the job can be confirmed, or is confirmed.
bool is_waiting(const Job& job);
// Reports whether the job waits and none of it was sent, so that its workpiece is not in the mill yet.
bool waits_to_begin(const Job& job);
// Returns the time to send and execute Job::part and all later parts, without the tool changes between them.
TimeRange takes(const Job& job);
// Returns the time to send and execute the parts after Job::part, without the tool changes.
TimeRange takes_later(const Job& job);
// Returns the run-on bound of Job::part; nullopt if it was not computed.
std::optional<RunOn> run_on(const Job& job);
// Sets the time and the run-on bound of Job::part.
void set_plan(Job& job, const TimeRange& takes, const RunOn& run_on);
// Reports whether the job is the rest of another job (Machine::add()) and none of it was sent.
bool is_fresh_rest(const Job& job);
// Returns the event to use when the confirmation of the job becomes void.
JobEvent void_event(const Job& job);

// Returns the settings that the job leaves and no command can undo, for people: "job 7 (part.rml) sets Z0".
std::vector<std::string> left_by(const Job& job);

// Returns Job::executed, which must be set, as text: "by the mill's profile what was executed ends between line 8,
// column 1 and line 13, column 1".
std::string executed_text(const Job& job);

// Returns the job as text for people: "job 7 (part.rml, by unix anna)".
std::string text_of(const Job& job);

}  // namespace axisgate::jobs
