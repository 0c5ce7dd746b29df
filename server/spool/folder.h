// The files of one device's jobs.
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

// Of a directory; none, where it is missing. internal, where it cannot be read.
Result<std::set<std::string>> names_in(const std::string& directory);

// ID.rml has the bytes of a job, ID.json what is known of it. A job is there once its ID.json is. What is const can be
// called by several threads at once for different jobs.
class Folder {
 public:
  explicit Folder(std::string path) : path_(std::move(path)) {}

  // Before anything else. Removes what an upload that was not finished has left. A job whose files are damaged is moved
  // aside, with an error in the log. internal, where the directory cannot be read.
  Result<std::vector<Job>> read();

  // Greater than any before, also of runs before; on the disk before it returns. internal, where it cannot be written.
  Result<std::uint64_t> next_id();

  std::string bytes_path(std::uint64_t id) const { return file(id, ".rml"); }
  // A file for the bytes of a job that has no number yet. Its path is another one each time.
  std::string next_upload_path();
  // Makes the file at such a path, and the directory. Fails with internal if the disk refuses it.
  Result<Descriptor> create(const std::string& upload) const;
  // Gives the bytes at such a path to a job of that number. Fails with internal if the disk refuses it.
  Result<void> take(const std::string& upload, std::uint64_t id) const;
  // Removes what is at such a path. Fails with internal if it may come back.
  Result<void> remove_upload(const std::string& upload) const;
  // What is known of a job whose bytes are synced, or what has become of it. internal, where it cannot be written.
  Result<void> keep(const Job& job) const;
  // internal, where they are not the bytes that were uploaded.
  Result<std::string> bytes_of(const Job& job) const;
  // Also of a job that is there in part only. internal, where it may come back: then it can be removed again.
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
