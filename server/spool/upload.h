// A job while its bytes are received.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "device/core/problem.h"
#include "device/link/descriptor.h"
#include "server/spool/folder.h"
#include "server/spool/job.h"
#include "server/spool/room.h"
#include "server/spool/sha256.h"

namespace axisgate::server::spool {

// An Upload is used by one thread at a time. Nothing of it stays on the disk unless finish() has succeeded.
class Upload {
 public:
  // Assigns a number to the job, takes its bytes from the path, and keeps it.
  using Keep = std::function<Result<Job>(Job, const std::string& path, std::unique_ptr<Place>)>;
  // `file` is open at `path`, also for reading. `folder` and everything that `keep` refers to must outlive the upload.
  Upload(const Folder& folder, std::string path, Descriptor file, Job job, std::unique_ptr<Place> place, Keep keep);
  ~Upload();
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  // Fails with out_of_range or queue_full as Place::grow() does, and with internal if the disk refuses it. After a
  // failure all later calls fail likewise, because a piece of the job is missing.
  Result<void> append(std::string_view bytes);
  // Passes on the bytes received, piece by piece. Must be called before finish(). Fails with internal if they cannot be
  // read.
  Result<void> read_back(const std::function<void(std::string_view)>& take);
  // Sets Job::facts. Must be called before finish().
  void set_facts(std::string facts) { job_.facts = std::move(facts); }
  // Waits for the disk; the job then has a number and survives a power cut. Fails with internal if the disk refuses it.
  // No function may be called afterwards.
  Result<Job> finish();

 private:
  Result<void> write(std::string_view bytes);
  Result<void> sync_and_close();

  const Folder& folder_;
  const std::string path_;
  Descriptor file_;
  Job job_;
  std::unique_ptr<Place> place_;
  const Keep keep_;
  Sha256 digest_;
  std::optional<Problem> refusal_;
  bool kept_ = false;
};

}  // namespace axisgate::server::spool
