// A job of a mill: what it is, what it needs set up at the mill, and its states.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/time.h"
#include "device/rml1/machine.h"

namespace axisgate::rml1 {

using JobNumber = std::uint64_t;  // of one mill; 0: none

// What a person sets up at the mill for a job. A confirmation counts for exactly this.
struct JobSetup {
  std::string digest;   // of its bytes: PreparedJob::digest()
  std::string profile;  // its name
  std::string origin;   // the name of a configured origin; empty: as it is set at the panel
  std::string tool;     // a configured name

  friend bool operator==(const JobSetup&, const JobSetup&) = default;
};

// README.md has the table of what leads from one to another.
enum class JobState { queued, confirmed, running, fed, done, aborted, paused_unknown, cancelled };
std::string_view name(JobState state);  // "QUEUED" ...
bool is_end(JobState state);

enum class JobEvent { confirm, make_void, start, fed, aborted, lost, done, cancel };
// The state after the event; nothing where the table has none.
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
  std::string name;  // a person's text
  std::string owner;
  JobSetup setup;
  std::uint64_t bytes = 0;
  double least_s = 0, most_s = 0;  // how long the mill takes
  JobState state = JobState::queued;
  std::optional<Confirmation> confirmation{};  // while it is confirmed
  std::optional<WrittenRange> written{};       // of one that is paused_unknown
};

// "job 7 (part.rml, by unix anna)".
std::string text_of(const Job& job);

}  // namespace axisgate::rml1
