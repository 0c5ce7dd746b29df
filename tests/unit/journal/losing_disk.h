// A disk that keeps for certain only what was synced, and whose power a test cuts.
//
// POSIX promises of fsync() that what was written before is kept. Of the rest, any part may survive, in any order.
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

// Of a write, each part within one sector survives whole or not at all, in bytes.
inline constexpr std::size_t kSector = 512;

class DiskFile {
 public:
  // As a program reads it now, synced or not.
  const std::string& bytes() const { return now_; }

  // A gap before `at` is filled with zeros.
  void write(std::size_t at, std::string_view bytes);
  void truncate(std::size_t size);
  void sync();
  // Leaves what was synced, with those changes since that `random` draws.
  void cut_power(simulation::Random& random);

 private:
  struct Change {
    std::size_t at = 0;
    std::optional<std::string> bytes{};  // nothing: the file was truncated to `at`
  };

  static void make(const Change& change, std::string& bytes);

  std::string now_, synced_;
  std::vector<Change> unsynced_;
};

// One directory of files. Not thread safe.
class LosingDisk {
 public:
  // Some disks acknowledge a sync of a file and do nothing.
  enum class FileSyncs { kept, ignored };
  explicit LosingDisk(FileSyncs syncs = FileSyncs::kept) : file_syncs_(syncs) {}

  // Null: there is none.
  std::shared_ptr<DiskFile> find(const std::string& name) const;
  std::shared_ptr<DiskFile> create(const std::string& name);
  void remove(const std::string& name);

  void sync(DiskFile& file);
  // What was created and removed. A file that was synced may still be lost with its name.
  void sync_directory();

  struct Cut {
    int sync = 1;        // counts from now and from 1, syncs of files and of the directory
    bool after = false;  // whether that sync still takes effect
    std::uint64_t seed = 0;
  };
  void plan(const Cut& cut) { plan_ = cut; }
  // At once.
  void cut_power(std::uint64_t seed);
  bool has_power() const { return power_; }
  // With what survived. No plan is left.
  void restore_power();

 private:
  void at_sync(const std::function<void()>& effect);

  const FileSyncs file_syncs_;
  // What each name has stood for since the directory was synced, oldest first; null: for nothing.
  std::map<std::string, std::vector<std::shared_ptr<DiskFile>>> names_;
  std::optional<Cut> plan_;
  bool power_ = true;
};

}  // namespace axisgate::disk_test
