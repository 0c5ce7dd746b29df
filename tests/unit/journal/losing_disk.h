// A disk that is certain to keep only synced data, and whose power a test cuts.
//
// POSIX promises that fsync() keeps everything written before it. Any part of the rest may survive, in any order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/simulation/random.h"

namespace axisgate::disk_test {

// Size in bytes of a sector. The part of a write within one sector survives whole or not at all.
inline constexpr std::size_t kSector = 512;

class DiskFile {
 public:
  // Returns the contents as a program reads them now, synced or not.
  const std::string& bytes() const { return now_; }

  // Fills a gap before `at` with zeros.
  void write(std::size_t at, std::string_view bytes);
  void truncate(std::size_t size);
  void sync();
  // Leaves the synced contents and the later changes that `random` selects.
  void cut_power(simulation::Random& random);

 private:
  struct Change {
    std::size_t at = 0;
    std::optional<std::string> bytes{};  // nullopt: the file was truncated to `at`
  };

  static void make(const Change& change, std::string& bytes);

  std::string now_, synced_;
  std::vector<Change> unsynced_;
};

// A directory of files. Not thread safe.
class LosingDisk {
 public:
  // Effect of syncing a file: some disks acknowledge the sync and do nothing.
  enum class FileSyncs { kept, ignored };
  explicit LosingDisk(FileSyncs syncs = FileSyncs::kept) : file_syncs_(syncs) {}

  // Returns null if there is no such file.
  std::shared_ptr<DiskFile> find(const std::string& name) const;
  std::shared_ptr<DiskFile> create(const std::string& name);
  void remove(const std::string& name);

  void sync(DiskFile& file);
  // Keeps all names created and removed up to now. Without this, even a synced file may be lost with its name.
  void sync_directory();

  struct Cut {
    int sync = 1;        // counted from 1 and from now, over files and directory
    bool after = false;  // true if that sync still takes effect
    std::uint64_t seed = 0;
  };
  void plan(const Cut& cut) { plan_ = cut; }
  // Cuts the power at once.
  void cut_power(std::uint64_t seed);
  bool has_power() const { return power_; }
  // Restores the power with the surviving data, and drops the plan.
  void restore_power();

 private:
  void at_sync(const std::function<void()>& effect);

  const FileSyncs file_syncs_;
  // Files that each name has denoted since the directory was synced, oldest first; null for no file.
  std::map<std::string, std::vector<std::shared_ptr<DiskFile>>> names_;
  std::optional<Cut> plan_;
  bool power_ = true;
};

}  // namespace axisgate::disk_test
