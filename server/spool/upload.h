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

// Used by one thread at a time. Nothing of it stays on the disk, unless finish() has succeeded.
class Upload {
 public:
  // Gives the job its number, takes its bytes from the path, and keeps it.
  using Keep = std::function<Result<Job>(Job, const std::string& path, std::unique_ptr<Place>)>;
  // `file`: open at `path`, for reading, too. `folder` outlives it, and what `keep` refers to does.
  Upload(const Folder& folder, std::string path, Descriptor file, Job job, std::unique_ptr<Place> place, Keep keep);
  ~Upload();
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  // out_of_range or queue_full as Place::grow(); internal, where the disk refuses it. A job that lacks a piece is none:
  // after a refusal all that follows is refused likewise.
  Result<void> append(std::string_view bytes);
  // Passes on the bytes that have come, piece by piece. Before finish(). Fails with internal if they cannot be read.
  Result<void> read_back(const std::function<void(std::string_view)>& take);
  // As Job::facts. Before finish().
  void set_facts(std::string facts) { job_.facts = std::move(facts); }
  // Waits for the disk; then the job has a number and is kept, also over a power cut. internal, where the disk refuses
  // it. Nothing is called after it.
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
