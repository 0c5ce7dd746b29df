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
// of an upload hold up nothing else.
class Spool {
 public:
  // Reads what runs before have left; what is damaged is moved aside (Folder::read()). Makes the directory, if it is
  // missing; where that fails, uploads are refused. internal, where it is no directory, cannot be read, or others may
  // write there.
  static Result<std::unique_ptr<Spool>> open(std::string directory, const Bounds& bounds);

  // Jobs that have ended give way to it, where there may be too little room: the oldest first. The Spool outlives the
  // upload. invalid_request as job_name(); unknown_device for what is no name of one; queue_full
  // as Room::take(); internal, where the disk refuses it.
  Result<std::unique_ptr<Upload>> begin(const std::string& device, NewJob fresh);

  std::vector<Job> list(const std::string& device) const;  // by number
  std::int64_t job_bytes_at_most() const { return bounds_.bytes_of_one; }

  // The next four: not_found, where the device has no such job.

  // internal, where they are not the bytes that were uploaded.
  Result<std::string> read(const std::string& device, std::uint64_t id) const;
  // internal, where the disk refuses it: then all is as before.
  Result<void> set_facts(const std::string& device, std::uint64_t id, std::string facts);
  // From now on Bounds::kept is counted; a job that has ended keeps its time. nullopt: the facts stay. internal,
  // likewise.
  Result<void> end(const std::string& device, std::uint64_t id, std::chrono::sys_seconds now,
                   std::optional<std::string> facts = {});
  // internal, where it may be there again after a power cut: until it is removed again.
  Result<void> remove(const std::string& device, std::uint64_t id);

  // Removes the jobs that ended Bounds::kept ago or earlier. The first problem, as remove(); the others are removed.
  Result<void> drop_old(std::chrono::sys_seconds now);

 private:
  struct Kept {
    Job job;
    std::unique_ptr<Place> place;
  };
  struct Device {
    Folder folder;  // next_id() and next_upload_path() under writing_
    std::map<std::uint64_t, Kept> jobs{};
  };
  struct Found {
    const Folder* folder;
    Job job;
  };

  Spool(std::string directory, const Bounds& bounds);
  Result<void> read_all();
  void make_room(const std::string& identity);          // under writing_
  bool drop_oldest_ended(const std::string* identity);  // false: there is none
  Device& device_of(const std::string& name);
  Result<Found> find(const std::string& device, std::uint64_t id) const;
  Result<Job> keep(Device& device, Job job, const std::string& upload, std::unique_ptr<Place> place);
  Result<void> drop(Device& device, std::uint64_t id);  // under writing_
  Result<void> change(const std::string& device, std::uint64_t id, const std::function<void(Job&)>& change);

  const std::string directory_;
  const Bounds bounds_;
  Room room_;
  std::mutex writing_;  // taken before the other
  mutable std::mutex mutex_;
  std::map<std::string, Device> devices_;  // none is ever removed
};

}  // namespace axisgate::server::spool
