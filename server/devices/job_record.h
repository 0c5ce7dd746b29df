// Which job a mill was sent, and how far, kept in a file so that a run after this one knows it if this one is killed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/rml1/mill/job.h"

namespace axisgate::server {

struct LastJob {
  rml1::JobNumber job = 0;
  rml1::JobState state = rml1::JobState::running;
  std::uint64_t through = 0;     // bytes of the job that may have gone to the line
  std::size_t part = 0;          // as Job::part
  std::uint64_t from = 0;        // as next_byte()
  std::uint64_t sent_least = 0;  // of Job::written, or as it was when the last bytes were written
  std::string name{};            // as Job::name; what it leaves is said with it
  rml1::Leaves leaves{};
};

// On the device's strand. The file is mapped, as that of MotionRecord: nothing waits for the disk, and a crash of the
// machine loses it.
class JobRecord {
 public:
  // `boot` names this boot of the machine. internal, where the file cannot be made or is no regular one.
  static Result<std::unique_ptr<JobRecord>> open(const std::string& path, std::string_view boot);
  ~JobRecord();
  JobRecord(const JobRecord&) = delete;
  JobRecord& operator=(const JobRecord&) = delete;

  // As the run before left it; nothing where no job was sent. After a boot of the machine any byte may have gone.
  const std::optional<LastJob>& before() const { return before_; }
  // The run before had an abort that had not left this host.
  bool abort_waited() const { return abort_waited_; }
  // MillController::surfaces() of the runs before.
  std::uint64_t surfaces() const;

  // Its next part, or the rest of that.
  void begin(const rml1::Job& job);
  // Before bytes up to sent.most are written; the mill has those up to sent.least.
  void going_to(const rml1::WrittenRange& sent);
  // Its state and its part. Of another job than the last that was begun: nothing.
  void set_state(const rml1::Job& job);
  void set_abort_waits(bool waits);
  void set_surfaces(std::uint64_t surfaces);

 private:
  struct Content;

  JobRecord(Content* content, std::string_view boot);

  Content* const content_;
  std::optional<LastJob> before_;
  bool abort_waited_ = false;
};

}  // namespace axisgate::server
