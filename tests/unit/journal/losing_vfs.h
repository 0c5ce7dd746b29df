// SQLite VFS on a LosingDisk.
#pragma once

#include <sqlite3.h>

#include <memory>

#include "tests/unit/journal/losing_disk.h"

namespace axisgate::disk_test {

// While a LosingVfs exists, SQLite reaches the disk's files through the VFS of its name. Locks and the shared memory of
// WAL mode belong to the process, so several connections may use one file; they end with the connections. Without
// power, every call fails with SQLITE_IOERR. Only one LosingVfs may exist at a time. Neither it nor its connections are
// thread safe.
class LosingVfs {
 public:
  // The disk must outlive the VFS, and the VFS must outlive all connections.
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
