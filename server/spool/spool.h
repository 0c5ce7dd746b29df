// Uploaded jobs, kept on disk until they have ended, and for some time after.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "server/spool/folder.h"
#include "server/spool/job.h"
#include "server/spool/room.h"
#include "server/spool/upload.h"

namespace axisgate::server::spool {

// Thread safe. Calls that write wait for the disk, and for each other; list() waits for neither. read() and the pieces
// of an upload delay no other call.
class Spool {
 public:
  // Reads the jobs of earlier runs, and moves damaged ones aside (Folder::read()). Makes the directory if it is
  // missing; if that fails, uploads are refused. Fails with internal if it is not a directory, cannot be read, or
  // others may write there.
  static Result<std::unique_ptr<Spool>> open(std::string directory, const Bounds& bounds);

  // Begins an upload. Removes ended jobs, oldest first, if there may be too little room. The Spool must outlive the
  // upload. Fails with invalid_request as job_name() does; with unknown_device if the text is not a device's name; with
  // queue_full as Room::take() does; and with internal if the disk refuses it.
  Result<std::unique_ptr<Upload>> begin(const std::string& device, NewJob fresh);

  std::vector<Job> list(const std::string& device) const;  // in order of number
  std::int64_t job_bytes_at_most() const { return bounds_.bytes_of_one; }

  // The next four functions fail with not_found if the device has no such job.

  // Returns the bytes of a job. Fails with internal if they are not the bytes that were uploaded.
  Result<std::string> read(const std::string& device, std::uint64_t id) const;
  // Fails with internal if the disk refuses it; nothing has changed then.
  Result<void> set_facts(const std::string& device, std::uint64_t id, std::string facts);
  // Notes that the job has ended: Bounds::kept counts from now on. A job that has ended already keeps its time.
  // nullopt: the facts stay. Fails with internal if the disk refuses it; nothing has changed then.
  Result<void> end(const std::string& device, std::uint64_t id, std::chrono::sys_seconds now,
                   std::optional<std::string> facts = {});
  // Fails with internal if the job may exist again after a power cut; it can then be removed again.
  Result<void> remove(const std::string& device, std::uint64_t id);

  // Removes the jobs that ended Bounds::kept ago or earlier. Returns the first problem, like remove(); the other jobs
  // are removed.
  Result<void> drop_old(std::chrono::sys_seconds now);

 private:
  struct Kept {
    Job job;
    std::unique_ptr<Place> place;
  };
  struct Device {
    Folder folder;  // next_id() and next_upload_path() are called under writing_
    std::map<std::uint64_t, Kept> jobs{};
  };
  struct Found {
    const Folder* folder;
    Job job;
  };

  Spool(std::string directory, const Bounds& bounds);
  Result<void> read_all();
  void make_room(const std::string& identity);          // called under writing_
  bool drop_oldest_ended(const std::string* identity);  // false: none was removed
  Device& device_of(const std::string& name);
  Result<Found> find(const std::string& device, std::uint64_t id) const;
  Result<Job> keep(Device& device, Job job, const std::string& upload, std::unique_ptr<Place> place);
  Result<void> drop(Device& device, std::uint64_t id);  // called under writing_
  Result<void> change(const std::string& device, std::uint64_t id, const std::function<void(Job&)>& change);

  const std::string directory_;
  const Bounds bounds_;
  Room room_;
  std::mutex writing_;  // locked before mutex_
  mutable std::mutex mutex_;
  std::map<std::string, Device> devices_;  // entries are never removed
};

}  // namespace axisgate::server::spool
