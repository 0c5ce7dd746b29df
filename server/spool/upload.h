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
  using Keep = std::function<Result<void>(const Job&, std::unique_ptr<Place>)>;
  // `folder` outlives it, and what `keep` refers to does.
  Upload(const Folder& folder, Descriptor file, Job job, std::unique_ptr<Place> place, Keep keep);
  ~Upload();
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  // out_of_range or queue_full as Place::grow(); internal, where the disk refuses it. A job that lacks a piece is none:
  // after a refusal all that follows is refused likewise.
  Result<void> append(std::string_view bytes);
  // As Job::facts. Before finish().
  void set_facts(std::string facts) { job_.facts = std::move(facts); }
  // Waits for the disk; then the job is kept, also over a power cut. internal, where the disk refuses it. Nothing is
  // called after it.
  Result<Job> finish();

 private:
  Result<void> write(std::string_view bytes);
  Result<void> sync_and_close();

  const Folder& folder_;
  Descriptor file_;
  Job job_;
  std::unique_ptr<Place> place_;
  const Keep keep_;
  Sha256 digest_;
  std::optional<Problem> refusal_;
  bool kept_ = false;
};

}  // namespace axisgate::server::spool
