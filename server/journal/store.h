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

// What is written together.
struct Record {
  Entry entry;
  RequestChange requests{};
  std::int64_t erased_person = 0;  // whose name is erased after the entry is written; 0: nobody's
};

// How much is kept; what is older is dropped in whole segments.
struct StoreBounds {
  std::chrono::hours age = std::chrono::hours(24 * 366);
  std::int64_t bytes = std::int64_t{1} << 30;
};

// The end of the chain. Noted outside, it shows that nothing up to there was changed.
struct Head {
  std::string epoch;        // of the file
  std::int64_t number = 0;  // of the last row; 0: none
  Hash hash{};
};

struct Verdict {
  std::int64_t rows = 0;                  // that were looked at
  std::optional<std::int64_t> first_bad;  // the number of a row
  std::string fault{};  // what is wrong with that row, or with what is no row, such as an index; empty: all is good
};

// Not thread safe; several of one file are.
class Store {
 public:
  // To write; made where it is missing. internal: the file cannot be opened, or a newer version has written it.
  // `vfs`: as of Database::open().
  static tl::expected<Store, Unopened> open(const std::string& path, const char* vfs = nullptr);
  static Result<Store> open_to_read(const std::string& path);

  // All of them are on the disk when it returns, or none.
  Result<void> append(std::span<const Record> records, const FactChange& facts = {});

  // So many entries are a segment.
  static constexpr std::int64_t kSegment = 10'000;
  // Drops the oldest segment, if it is too old or the file too large; whether it did. Its last hash stays, in the
  // entry that says so, and the chain begins there. The newest segment is never dropped. `as_of`: when, and by which
  // clocks.
  Result<bool> drop_old(const StoreBounds& bounds, const Entry& as_of);

  // At most `limit`, in the order of their numbers.
  Result<std::vector<StoredEntry>> read(const Filter& filter, std::size_t limit);
  Result<std::optional<NamedPerson>> find_person(std::string_view name) { return PersonTable(database_).find(name); }
  // As Database::empty_log().
  Result<void> empty_log() { return database_.empty_log(); }
  Result<RequestsOnFile> requests() { return RequestTable(database_).read(); }
  // Whether the newest run of the daemon has no end. Of an empty file: no.
  Result<bool> ended_uncleanly();
  // Once for each run, before its start is appended: FactTable::begin().
  Result<FactsBefore> begin_facts(bool after_unclean_end) { return FactTable(database_).begin(after_unclean_end); }
  // What, added to the time since this boot, gives a clock that continues over boots. `boot` names this one.
  Result<Duration> boot_offset(std::string_view boot, TimePoint now);
  // A different text for each new file.
  Result<std::string> epoch();
  // The entries of motions of the newest run of the daemon that were requested, and have not ended.
  Result<std::vector<StoredEntry>> unfinished_motions();
  // The highest number of a motion of the device; 0: it had none.
  Result<std::uint64_t> last_motion(std::string_view device);
  Result<Head> head();
  // Computes all hashes again, and looks whether the indices agree with the rows. `noted`: a head of before, that must
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
