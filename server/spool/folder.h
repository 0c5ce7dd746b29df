// Files of one device's jobs.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/problem.h"
#include "device/link/descriptor.h"
#include "server/spool/job.h"

namespace axisgate::server::spool {

// Returns the names in a directory; none if it is missing. Fails with internal if it cannot be read.
Result<std::set<std::string>> names_in(const std::string& directory);

// A Folder stores the bytes of a job in ID.rml, and its record in ID.json. A job exists once its ID.json does. Several
// threads may call const functions at the same time for different jobs.
class Folder {
 public:
  explicit Folder(std::string path) : path_(std::move(path)) {}

  // Reads all jobs; must be called first. Removes what an unfinished upload left behind. Moves jobs with damaged files
  // aside, with an error in the log. Fails with internal if the directory cannot be read.
  Result<std::vector<Job>> read();

  // Returns a number greater than any before, also of earlier runs. The number is on the disk before this returns.
  // Fails with internal if it cannot be written.
  Result<std::uint64_t> next_id();

  std::string bytes_path(std::uint64_t id) const { return file(id, ".rml"); }
  // Returns a path for the bytes of a job that has no number yet; a different one at each call.
  std::string next_upload_path();
  // Makes the file at an upload path, and the directory. Fails with internal if the disk refuses it.
  Result<Descriptor> create(const std::string& upload) const;
  // Moves the bytes at an upload path to the job with that number. Fails with internal if the disk refuses it.
  Result<void> take(const std::string& upload, std::uint64_t id) const;
  // Removes the file at an upload path. Fails with internal if it may exist again after a power cut.
  Result<void> remove_upload(const std::string& upload) const;
  // Writes the record of a job whose bytes are synced, or its new state. Fails with internal if it cannot be written.
  Result<void> keep(const Job& job) const;
  // Returns the bytes of a job. Fails with internal if they are not the bytes that were uploaded.
  Result<std::string> bytes_of(const Job& job) const;
  // Removes a job, also an incomplete one. Fails with internal if the job may exist again after a power cut; it can
  // then be removed again.
  Result<void> remove(std::uint64_t id) const;

 private:
  std::string file(std::uint64_t id, std::string_view suffix) const;
  Result<Job> read_job(std::uint64_t id) const;
  Result<void> read_bytes(const Job& job, const std::function<void(std::string_view)>& take) const;
  void move_aside(std::uint64_t id, const Problem& why) const;
  std::uint64_t last_on_disk() const;

  const std::string path_;
  std::uint64_t last_ = 0, uploads_ = 0;
};

}  // namespace axisgate::server::spool
