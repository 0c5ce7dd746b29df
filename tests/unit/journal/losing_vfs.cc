#include "tests/unit/journal/losing_vfs.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace axisgate::disk_test {
namespace {

struct OpenFile;

// State that the connections to one file share, outside the disk.
struct Sharing {
  std::vector<OpenFile*> connections;
  std::vector<std::unique_ptr<char[]>> memory;  // regions of xShmMap
};

// SQLite allocates the bytes of an OpenFile, and calls xOpen before and xClose after all other methods.
struct OpenFile : sqlite3_file {
  OpenFile(LosingDisk& its_disk, std::shared_ptr<DiskFile> its_file, Sharing& its_sharing)
      : sqlite3_file{}, disk(its_disk), file(std::move(its_file)), sharing(its_sharing) {
    sharing.connections.push_back(this);
  }
  ~OpenFile() { std::erase(sharing.connections, this); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  // Reports whether `condition` is true of another connection to the file.
  template <class Condition>
  bool any_other(Condition condition) const {
    return std::ranges::any_of(sharing.connections,
                               [&](const OpenFile* one) { return one != this && condition(*one); });
  }

  LosingDisk& disk;
  const std::shared_ptr<DiskFile> file;
  Sharing& sharing;
  bool syncs_directory = false;  // true if the next sync also syncs the directory
  int lock = SQLITE_LOCK_NONE;
  bool has_memory = false;
  unsigned shared_slots = 0, exclusive_slots = 0;  // a bit for each lock of the shared memory
};

OpenFile& open_file(sqlite3_file* file) { return *static_cast<OpenFile*>(file); }

int result(const LosingDisk& disk) { return disk.has_power() ? SQLITE_OK : SQLITE_IOERR; }

int close(sqlite3_file* file) {
  open_file(file).~OpenFile();
  return SQLITE_OK;
}

int read(sqlite3_file* file, void* to, int count, sqlite3_int64 at) {
  const OpenFile& from = open_file(file);
  const std::string& bytes = from.file->bytes();
  const auto begin = std::min(static_cast<std::size_t>(at), bytes.size());
  const auto size = std::min(static_cast<std::size_t>(count), bytes.size() - begin);
  std::memset(to, 0, static_cast<std::size_t>(count));
  std::memcpy(to, bytes.data() + begin, size);
  if (!from.disk.has_power()) return SQLITE_IOERR;
  return size == static_cast<std::size_t>(count) ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
}

int write(sqlite3_file* file, const void* from, int count, sqlite3_int64 at) {
  const OpenFile& to = open_file(file);
  if (!to.disk.has_power()) return SQLITE_IOERR;
  to.file->write(static_cast<std::size_t>(at), {static_cast<const char*>(from), static_cast<std::size_t>(count)});
  return SQLITE_OK;
}

int truncate(sqlite3_file* file, sqlite3_int64 size) {
  const OpenFile& one = open_file(file);
  if (!one.disk.has_power()) return SQLITE_IOERR;
  one.file->truncate(static_cast<std::size_t>(size));
  return SQLITE_OK;
}

int sync(sqlite3_file* file, int) {
  OpenFile& one = open_file(file);
  if (one.disk.has_power()) one.disk.sync(*one.file);
  if (one.disk.has_power() && std::exchange(one.syncs_directory, false)) one.disk.sync_directory();
  return result(one.disk);
}

int file_size(sqlite3_file* file, sqlite3_int64* size) {
  *size = static_cast<sqlite3_int64>(open_file(file).file->bytes().size());
  return result(open_file(file).disk);
}

// SQLite's five lock levels: https://www.sqlite.org/lockingv3.html, section 3.
int lock(sqlite3_file* file, int level) {
  OpenFile& one = open_file(file);
  if (one.lock >= level) return SQLITE_OK;
  const int refused_at = level == SQLITE_LOCK_SHARED ? SQLITE_LOCK_PENDING : SQLITE_LOCK_RESERVED;
  if (one.any_other([&](const OpenFile& other) { return other.lock >= refused_at; })) return SQLITE_BUSY;
  const bool has_readers = one.any_other([](const OpenFile& other) { return other.lock >= SQLITE_LOCK_SHARED; });
  const bool waits = level == SQLITE_LOCK_EXCLUSIVE && has_readers;
  one.lock = waits ? SQLITE_LOCK_PENDING : level;
  return waits ? SQLITE_BUSY : SQLITE_OK;
}

int unlock(sqlite3_file* file, int level) {
  open_file(file).lock = std::min(open_file(file).lock, level);
  return SQLITE_OK;
}

int check_reserved_lock(sqlite3_file* file, int* reserved) {
  *reserved = open_file(file).any_other([](const OpenFile& other) { return other.lock >= SQLITE_LOCK_RESERVED; });
  return SQLITE_OK;
}

int file_control(sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; }

// Both values are those of SQLite's own VFS for Linux, which the daemon uses.
int sector_size(sqlite3_file*) { return 4096; }
int device_characteristics(sqlite3_file*) { return SQLITE_IOCAP_POWERSAFE_OVERWRITE; }

int shm_map(sqlite3_file* file, int region, int size, int extend, void volatile** at) {
  OpenFile& one = open_file(file);
  one.has_memory = true;
  auto& memory = one.sharing.memory;
  while (extend != 0 && memory.size() <= static_cast<std::size_t>(region)) {
    memory.push_back(std::make_unique<char[]>(static_cast<std::size_t>(size)));
  }
  const bool there = static_cast<std::size_t>(region) < memory.size();
  *at = there ? memory[static_cast<std::size_t>(region)].get() : nullptr;
  return SQLITE_OK;
}

int shm_lock(sqlite3_file* file, int first, int count, int flags) {
  OpenFile& one = open_file(file);
  const unsigned slots = ((1u << count) - 1) << first;
  const bool exclusive = (flags & SQLITE_SHM_EXCLUSIVE) != 0;
  unsigned& own = exclusive ? one.exclusive_slots : one.shared_slots;
  if ((flags & SQLITE_SHM_UNLOCK) != 0) {
    own &= ~slots;
    return SQLITE_OK;
  }
  const auto refuses = [&](const OpenFile& other) {
    return ((other.exclusive_slots | (exclusive ? other.shared_slots : 0)) & slots) != 0;
  };
  if (one.any_other(refuses)) return SQLITE_BUSY;
  own |= slots;
  return SQLITE_OK;
}

void shm_barrier(sqlite3_file*) {}

int shm_unmap(sqlite3_file* file, int) {
  OpenFile& one = open_file(file);
  one.has_memory = false;
  if (!one.any_other([](const OpenFile& other) { return other.has_memory; })) one.sharing.memory.clear();
  return SQLITE_OK;
}

constexpr sqlite3_io_methods kMethods{.iVersion = 2,
                                      .xClose = close,
                                      .xRead = read,
                                      .xWrite = write,
                                      .xTruncate = truncate,
                                      .xSync = sync,
                                      .xFileSize = file_size,
                                      .xLock = lock,
                                      .xUnlock = unlock,
                                      .xCheckReservedLock = check_reserved_lock,
                                      .xFileControl = file_control,
                                      .xSectorSize = sector_size,
                                      .xDeviceCharacteristics = device_characteristics,
                                      .xShmMap = shm_map,
                                      .xShmLock = shm_lock,
                                      .xShmBarrier = shm_barrier,
                                      .xShmUnmap = shm_unmap,
                                      .xFetch = nullptr,
                                      .xUnfetch = nullptr};

}  // namespace

struct LosingVfs::Machine {
  LosingDisk& disk;
  std::map<std::string, Sharing> sharing{};  // by file name
};

namespace {

LosingVfs::Machine& machine(sqlite3_vfs* vfs) { return *static_cast<LosingVfs::Machine*>(vfs->pAppData); }

int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* opened_flags) {
  file->pMethods = nullptr;
  auto& [disk, sharing] = machine(vfs);
  if (name == nullptr) return SQLITE_CANTOPEN;  // a null name is a temporary file, which the journal never needs
  if (!disk.has_power()) return SQLITE_IOERR;
  auto there = disk.find(name);
  const bool may_create = (flags & SQLITE_OPEN_CREATE) != 0;
  if (!there && !may_create) return SQLITE_CANTOPEN;
  auto* opened = new (file) OpenFile(disk, there ? there : disk.create(name), sharing[name]);
  opened->pMethods = &kMethods;
  // Like SQLite's own VFS for Linux: the first sync of a log also syncs the directory, a sync of the main file never
  // does.
  constexpr int kLogs = SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_WAL | SQLITE_OPEN_SUPER_JOURNAL;
  opened->syncs_directory = may_create && (flags & kLogs) != 0;
  if (opened_flags != nullptr) *opened_flags = flags;
  return SQLITE_OK;
}

int remove(sqlite3_vfs* vfs, const char* name, int sync_directory) {
  LosingDisk& disk = machine(vfs).disk;
  if (!disk.has_power()) return SQLITE_IOERR;
  if (!disk.find(name)) return SQLITE_IOERR_DELETE_NOENT;
  disk.remove(name);
  if (sync_directory != 0) disk.sync_directory();
  return result(disk);
}

// An empty file counts as missing, as with SQLite's own VFS for Linux.
int access(sqlite3_vfs* vfs, const char* name, int, int* there) {
  const auto found = machine(vfs).disk.find(name);
  *there = found && !found->bytes().empty();
  return result(machine(vfs).disk);
}

int full_pathname(sqlite3_vfs*, const char* name, int size, char* out) {
  sqlite3_snprintf(size, out, "%s", name);
  return SQLITE_OK;
}

}  // namespace

// Time and random numbers come from the system's own VFS.
LosingVfs::LosingVfs(LosingDisk& disk)
    : machine_(std::make_unique<Machine>(Machine{disk})), vfs_(*sqlite3_vfs_find(nullptr)) {
  vfs_.iVersion = 2;
  vfs_.szOsFile = sizeof(OpenFile);
  vfs_.zName = "losing";
  vfs_.pAppData = machine_.get();
  vfs_.xOpen = open;
  vfs_.xDelete = remove;
  vfs_.xAccess = access;
  vfs_.xFullPathname = full_pathname;
  sqlite3_vfs_register(&vfs_, 0);
}

LosingVfs::~LosingVfs() { sqlite3_vfs_unregister(&vfs_); }

}  // namespace axisgate::disk_test
