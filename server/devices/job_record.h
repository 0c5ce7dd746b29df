// File with the last job sent to a mill, and the bytes sent, so that the next run knows both after this run was killed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/jobs/job.h"

namespace axisgate::server {

struct LastJob {
  jobs::JobNumber job = 0;
  jobs::JobState state = jobs::JobState::running;
  std::uint64_t through = 0;     // bytes of the job that may have been written to the line
  std::size_t part = 0;          // value of Job::part
  std::uint64_t from = 0;        // value of next_byte()
  std::uint64_t sent_least = 0;  // `least` of Job::written, or the value at the time of the last write
  std::string name{};            // value of Job::name, for messages about what the job leaves
  jobs::Leaves leaves{};
};

// Runs on the device's strand. The file is mapped like that of MotionRecord: no call waits for the disk, and a crash of
// the machine loses it.
class JobRecord {
 public:
  // `boot` names this boot of the machine. Fails with internal if the file cannot be created or is not a regular file.
  static Result<std::unique_ptr<JobRecord>> open(const std::string& path, std::string_view boot);
  ~JobRecord();
  JobRecord(const JobRecord&) = delete;
  JobRecord& operator=(const JobRecord&) = delete;

  // Returns the job that the previous run left; nullopt if no job was sent. After a boot of the machine any byte may
  // have been sent.
  const std::optional<LastJob>& before() const { return before_; }
  // Reports whether the previous run had an abort that had not left this host.
  bool abort_waited() const { return abort_waited_; }
  // Machine::z0_count() of earlier runs.
  std::uint64_t z0_count() const;

  // Records the start of a job, of its next part, or of the rest of a part.
  void begin(const jobs::Job& job);
  // Records that bytes up to sent.most are written next, and that the mill has those up to sent.least.
  void going_to(const jobs::WrittenRange& sent);
  // Records the job's state and part. Has no effect unless the job is the last that was begun.
  void set_state(const jobs::Job& job);
  void set_abort_waits(bool waits);
  void set_z0_count(std::uint64_t z0_count);

 private:
  struct Content;

  JobRecord(Content* content, std::string_view boot);

  Content* const content_;
  std::optional<LastJob> before_;
  bool abort_waited_ = false;
};

}  // namespace axisgate::server
