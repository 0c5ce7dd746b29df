// The thread that writes the journal.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/journal/store.h"

namespace axisgate::server::journal {

// Thread safe. Entries that are appended while others are written are committed together.
class Journal {
 public:
  // Beyond so many that wait for the disk, entries are left out, and the journal says how many.
  static constexpr std::size_t kWaitingMax = 10'000;

  // As Store::open(). A damaged file is moved aside, with a warning that names it, and a new one begins.
  static Result<std::unique_ptr<Journal>> open(const std::string& path);
  // Writes what waits, if the disk takes it.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Never waits for the disk. Where the disk refuses, it is tried again each second.
  void append(Entry entry);
  // Why nothing is written now; nothing while the disk takes what comes.
  std::optional<Problem> failure() const;

  // Each with a connection of its own, for threads that may wait. What was appended before is found, unless the disk
  // refuses it or is slow.
  Result<std::vector<StoredEntry>> read(const Filter& filter, std::size_t limit) const;
  Result<std::uint64_t> last_motion(std::string_view device) const;
  Result<Verdict> verify(const std::optional<Head>& noted) const;
  Result<Head> head() const;

 private:
  Journal(std::string path, Store store);

  Result<Store> reader() const;
  void run();
  std::vector<Entry> wait_for_entries();
  // Until they are written; false where the daemon ends before.
  bool write(const std::vector<Entry>& entries);

  const std::string path_;
  Store store_;  // of the thread
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::vector<Entry> waiting_;
  bool writing_ = false;
  std::uint64_t left_out_ = 0;
  std::optional<Problem> failure_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace axisgate::server::journal
