#include "server/spool/spool.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <utility>

#include "device/core/escape.h"
#include "server/access/synced_file.h"
#include "server/access/writers.h"
#include "server/config/name.h"
#include "server/spool/job_name.h"

namespace axisgate::server::spool {
namespace {

// Accepts a missing directory, because the first upload makes it.
Result<void> check_directory(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  if (!S_ISDIR(status.st_mode)) {
    return fail(Reason::internal, fmt::format("{} is not a directory", path),
                "move it away: the daemon makes this directory itself");
  }
  if (const Result<void> checked = check_writers(path, status); !checked) {
    return fail(Reason::internal, fmt::format("{} {}", path, checked.error().message), checked.error().hint);
  }
  return {};
}

}  // namespace

Spool::Spool(std::string directory, const Bounds& bounds)
    : directory_(std::move(directory)), bounds_(bounds), room_(bounds) {}

Result<std::unique_ptr<Spool>> Spool::open(std::string directory, const Bounds& bounds) {
  std::unique_ptr<Spool> spool(new Spool(std::move(directory), bounds));
  make_state_directory(spool->directory_);
  if (const Result<void> read = spool->read_all(); !read) return tl::unexpected(read.error());
  return spool;
}

Result<void> Spool::read_all() {
  if (Result<void> checked = check_directory(directory_); !checked) return checked;
  const auto names = names_in(directory_);
  if (!names) return tl::unexpected(names.error());
  for (const std::string& name : *names) {
    if (!is_name(name)) continue;
    if (Result<void> checked = check_directory(directory_ + "/" + name); !checked) return checked;
    Device& device = device_of(name);
    auto jobs = device.folder.read();
    if (!jobs) return tl::unexpected(jobs.error());
    for (Job& job : *jobs) {
      auto place = room_.hold(job.identity, job.bytes, job.ended.has_value());
      device.jobs.emplace(job.id, Kept{std::move(job), std::move(place)});
    }
  }
  return {};
}

Spool::Device& Spool::device_of(const std::string& name) {
  const std::lock_guard lock(mutex_);
  return devices_.try_emplace(name, Folder(directory_ + "/" + name)).first->second;
}

Result<std::unique_ptr<Upload>> Spool::begin(const std::string& device, NewJob fresh) {
  if (!is_name(device)) return fail(Reason::unknown_device, fmt::format("there is no device {}", quoted_bytes(device)));
  auto name = job_name(fresh.name);
  if (!name) return tl::unexpected(name.error());
  (void)drop_old(fresh.created);  // a problem of the disk shows again when the job is written
  Device& home = device_of(device);
  const std::lock_guard writing(writing_);
  make_room(fresh.identity);
  auto place = room_.take(fresh.identity);
  if (!place) return tl::unexpected(place.error());
  const std::string path = home.folder.next_upload_path();
  auto file = home.folder.create(path);
  if (!file) return tl::unexpected(file.error());
  Job job{.name = *std::move(name),
          .who = std::move(fresh.who),
          .identity = std::move(fresh.identity),
          .created = fresh.created,
          .facts = std::move(fresh.facts)};
  return std::make_unique<Upload>(
      home.folder, path, *std::move(file), std::move(job), *std::move(place),
      [this, &home](const Job& whole, const std::string& upload, std::unique_ptr<Place> held) {
        return keep(home, whole, upload, std::move(held));
      });
}

void Spool::make_room(const std::string& identity) {
  while (room_.is_short_for(identity) && drop_oldest_ended(&identity)) continue;
  while (room_.is_short() && drop_oldest_ended(nullptr)) continue;
}

bool Spool::drop_oldest_ended(const std::string* identity) {
  Device* home = nullptr;
  const Job* oldest = nullptr;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [name, device] : devices_) {
      for (const auto& [id, kept] : device.jobs) {
        const bool gives_way = kept.job.ended && (identity == nullptr || kept.job.identity == *identity);
        if (!gives_way || (oldest != nullptr && *oldest->ended <= *kept.job.ended)) continue;
        home = &device;
        oldest = &kept.job;
      }
    }
  }
  return oldest != nullptr && drop(*home, oldest->id).has_value();
}

// Assigns the number last, so that refused uploads leave no gaps.
Result<Job> Spool::keep(Device& device, Job job, const std::string& upload, std::unique_ptr<Place> place) {
  const std::lock_guard writing(writing_);
  const Result<std::uint64_t> id = device.folder.next_id();
  if (!id) return tl::unexpected(id.error());
  job.id = *id;
  if (const Result<void> taken = device.folder.take(upload, job.id); !taken) return tl::unexpected(taken.error());
  if (const Result<void> written = device.folder.keep(job); !written) {
    (void)device.folder.remove(job.id);
    return tl::unexpected(written.error());
  }
  const std::lock_guard lock(mutex_);
  device.jobs.emplace(job.id, Kept{job, std::move(place)});
  return job;
}

std::vector<Job> Spool::list(const std::string& device) const {
  const std::lock_guard lock(mutex_);
  std::vector<Job> jobs;
  if (const auto found = devices_.find(device); found != devices_.end()) {
    for (const auto& [id, kept] : found->second.jobs) jobs.push_back(kept.job);
  }
  return jobs;
}

Result<Spool::Found> Spool::find(const std::string& device, std::uint64_t id) const {
  const std::lock_guard lock(mutex_);
  if (const auto home = devices_.find(device); home != devices_.end()) {
    const auto kept = home->second.jobs.find(id);
    if (kept != home->second.jobs.end()) return Found{&home->second.folder, kept->second.job};
  }
  return fail(Reason::not_found, fmt::format("there is no job {} on {}", id, quoted_bytes(device)));
}

Result<std::string> Spool::read(const std::string& device, std::uint64_t id) const {
  const auto found = find(device, id);
  if (!found) return tl::unexpected(found.error());
  auto bytes = found->folder->bytes_of(found->job);
  if (bytes) return bytes;
  // The job may have been removed meanwhile.
  const auto still = find(device, id);
  return still ? bytes : tl::unexpected(still.error());
}

Result<void> Spool::change(const std::string& device, std::uint64_t id, const std::function<void(Job&)>& change) {
  const std::lock_guard writing(writing_);
  auto found = find(device, id);
  if (!found) return tl::unexpected(found.error());
  change(found->job);
  if (Result<void> written = found->folder->keep(found->job); !written) return written;
  const std::lock_guard lock(mutex_);
  Kept& kept = devices_.at(device).jobs.at(id);
  kept.job = std::move(found->job);
  if (kept.job.ended) kept.place->end();
  return {};
}

Result<void> Spool::set_facts(const std::string& device, std::uint64_t id, std::string facts) {
  return change(device, id, [&facts](Job& job) { job.facts = std::move(facts); });
}

Result<void> Spool::end(const std::string& device, std::uint64_t id, std::chrono::sys_seconds now,
                        std::optional<std::string> facts) {
  return change(device, id, [&](Job& job) {
    job.ended = job.ended.value_or(now);
    if (facts) job.facts = *std::move(facts);
  });
}

Result<void> Spool::remove(const std::string& device, std::uint64_t id) {
  const std::lock_guard writing(writing_);
  if (const auto found = find(device, id); !found) return tl::unexpected(found.error());
  return drop(device_of(device), id);
}

Result<void> Spool::drop_old(std::chrono::sys_seconds now) {
  const std::lock_guard writing(writing_);
  std::vector<std::pair<Device*, std::uint64_t>> old;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [name, device] : devices_) {
      for (const auto& [id, kept] : device.jobs) {
        if (kept.job.ended && now - *kept.job.ended >= bounds_.kept) old.emplace_back(&device, id);
      }
    }
  }
  Result<void> all;
  for (const auto& [device, id] : old) {
    const Result<void> dropped = drop(*device, id);
    if (!dropped && all) all = dropped;
  }
  return all;
}

Result<void> Spool::drop(Device& device, std::uint64_t id) {
  // Removes the job before its files, so that read() can distinguish removed jobs from damaged ones.
  std::unique_lock lock(mutex_);
  auto job = device.jobs.extract(id);
  lock.unlock();
  Result<void> removed = device.folder.remove(id);
  if (removed) return removed;
  lock.lock();
  device.jobs.insert(std::move(job));
  return removed;
}

}  // namespace axisgate::server::spool
