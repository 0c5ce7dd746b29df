// The journal's file: its schema, appending, reading, verifying.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/journal/conditions.h"
#include "server/journal/database.h"
#include "server/journal/entry.h"
#include "server/journal/fact_table.h"
#include "server/journal/person_table.h"
#include "server/journal/request_table.h"

namespace axisgate::server::journal {

// Changes that are written together.
struct Record {
  Entry entry;
  RequestChange requests{};
  std::int64_t erased_person = 0;  // number of the caller whose name is erased after the entry is written; 0: none
};

// Limits of age and size; older entries are dropped in whole segments.
struct StoreBounds {
  std::chrono::hours age = std::chrono::hours(24 * 366);
  std::int64_t bytes = std::int64_t{1} << 30;
};

// End of the chain. A copy kept elsewhere proves later that no entry up to it was changed.
struct Head {
  std::string epoch;        // epoch of the file
  std::int64_t number = 0;  // number of the last row; 0: none
  Hash hash{};
};

struct Verdict {
  std::int64_t rows = 0;                  // number of rows checked
  std::optional<std::int64_t> first_bad;  // number of the first bad row
  std::string fault{};  // fault of the first bad row, or of another part such as an index; empty: no fault
};

// Not thread safe, but several stores of one file may be used at the same time.
class Store {
 public:
  // Opens a file to write, and creates a missing one. Fails with internal if the file cannot be opened, or if a newer
  // version has written it. `vfs`: see Database::open().
  static tl::expected<Store, Unopened> open(const std::string& path, const char* vfs = nullptr);
  static Result<Store> open_to_read(const std::string& path);

  // Writes all records and facts, or none if it fails. They are on the disk when it returns.
  Result<void> append(std::span<const Record> records, const FactChange& facts = {});

  // Number of entries in a segment.
  static constexpr std::int64_t kSegment = 10'000;
  // Drops the oldest segment if it is too old or the file is too large, and reports whether it did. The segment's last
  // hash stays in the entry about it, and the chain begins there. The newest segment is never dropped. `as_of`: the
  // present time, by both clocks.
  Result<bool> drop_old(const StoreBounds& bounds, const Entry& as_of);

  // Returns at most `limit` entries, ordered by number.
  Result<std::vector<StoredEntry>> read(const Filter& filter, std::size_t limit);
  Result<std::optional<NamedPerson>> find_person(std::string_view name) { return PersonTable(database_).find(name); }
  // See Database::empty_log().
  Result<void> empty_log() { return database_.empty_log(); }
  Result<RequestsOnFile> requests() { return RequestTable(database_).read(); }
  // Reports whether the newest run of the daemon has no end. False for an empty file.
  Result<bool> ended_uncleanly();
  // Call once in each run, before its start is appended; see FactTable::begin().
  Result<FactsBefore> begin_facts(bool after_unclean_end) { return FactTable(database_).begin(after_unclean_end); }
  // Returns the offset that, added to the time since this boot, gives a clock that continues after a reboot. `boot`
  // names this boot.
  Result<Duration> boot_offset(std::string_view boot, TimePoint now);
  // Returns a text that is different for each new file.
  Result<std::string> epoch();
  // Returns the requested motions of the daemon's newest run that have not ended.
  Result<std::vector<StoredEntry>> unfinished_motions();
  // Returns the highest number of a motion of the device; 0 if it had none.
  Result<std::uint64_t> last_motion(std::string_view device);
  Result<Head> head();
  // Computes all hashes again, and checks that the indices agree with the rows. `noted`: an earlier head that must
  // still be part of the chain.
  Result<Verdict> verify(const std::optional<Head>& noted);

 private:
  explicit Store(Database database) : database_(std::move(database)) {}

  Result<void> check_schema(const std::string& path);
  Result<void> make_schema();
  Result<void> upgrade(std::int64_t from);
  Result<void> add(const Entry& entry, Head& head);
  Result<Head> dropped();
  Result<void> drop(const Head& through, const Entry& as_of);
  Result<bool> is_beyond(const StoreBounds& bounds, WallTime newest_in_segment, WallTime now);
  Result<void> erase(std::int64_t person);
  Result<Verdict> verify_chain(const std::optional<Head>& noted);
  Result<std::string> first_complaint();
  static Result<std::vector<StoredEntry>> all_of(Statement& rows);
  Result<std::string> meta(std::string_view key);
  Result<void> set_meta(std::string_view key, std::string_view value);

  Database database_;
};

}  // namespace axisgate::server::journal
