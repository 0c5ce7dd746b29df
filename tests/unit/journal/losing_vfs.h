// SQLite on a LosingDisk.
#pragma once

#include <sqlite3.h>

#include <memory>

#include "tests/unit/journal/losing_disk.h"

namespace axisgate::disk_test {

// While it lives, a VFS by its name has the disk's files. Locks and the shared memory of WAL mode are the process's
// own, so that several connections may use one file; they end with the connections. Without power everything fails with
// SQLITE_IOERR. One at a time. Not thread safe, nor are its connections.
class LosingVfs {
 public:
  // The disk outlives it, and it outlives all connections.
  explicit LosingVfs(LosingDisk& disk);
  ~LosingVfs();
  LosingVfs(const LosingVfs&) = delete;
  LosingVfs& operator=(const LosingVfs&) = delete;

  const char* name() const { return vfs_.zName; }

  struct Machine;

 private:
  std::unique_ptr<Machine> machine_;
  sqlite3_vfs vfs_;
};

}  // namespace axisgate::disk_test
