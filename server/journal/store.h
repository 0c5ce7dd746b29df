// The journal's file: its schema, appending, reading, verifying.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/journal/database.h"
#include "server/journal/entry.h"
#include "server/journal/request_table.h"

namespace axisgate::server::journal {

// What is written together.
struct Record {
  Entry entry;
  RequestChange requests{};
};

// Which entries are wanted. All, where nothing is said.
struct Filter {
  std::optional<WallTime> from{}, to{};  // from <= time < to
  std::string device{}, who{};
  std::uint64_t motion = 0;
  std::vector<EntryKind> kinds{};
  std::int64_t before = 0;  // numbers below this one: where the page before ended
  std::int64_t after = 0;   // numbers above this one
  int axis = 0;             // that the body names; 0: all
  std::string outcome{};    // of an end of a motion: "FAILED"; empty: all entries
  std::string text{};       // a part of the body; capital and small letters differ
  bool oldest_first = false;
};

// SQL: the body of an entry. A file that was changed may have text there that is no JSON.
inline constexpr std::string_view kJsonBody = "iif(json_valid(body), body, '{}')";

// The end of the chain. Noted outside, it shows that nothing up to there was changed.
struct Head {
  std::string epoch;        // of the file
  std::int64_t number = 0;  // of the last row; 0: none
  Hash hash{};
};

struct Verdict {
  std::int64_t rows = 0;                  // that were looked at
  std::optional<std::int64_t> first_bad;  // its number
  std::string fault{};                    // what is wrong with it
};

// Not thread safe; several of one file are.
class Store {
 public:
  // To write; made where it is missing. internal: the file cannot be opened, or a newer version has written it.
  // `vfs`: as of Database::open().
  static tl::expected<Store, Unopened> open(const std::string& path, const char* vfs = nullptr);
  static Result<Store> open_to_read(const std::string& path);

  // All of them are on the disk when it returns, or none.
  Result<void> append(std::span<const Record> records);

  // At most `limit`, in the order of their numbers.
  Result<std::vector<StoredEntry>> read(const Filter& filter, std::size_t limit);
  Result<RequestsOnFile> requests() { return RequestTable(database_).read(); }
  // What, added to the time since this boot, gives a clock that continues over boots. `boot` names this one.
  Result<Duration> boot_offset(std::string_view boot, TimePoint now);
  // A different text for each new file.
  Result<std::string> epoch();
  // The entries of motions of the newest run of the daemon that were requested, and have not ended.
  Result<std::vector<StoredEntry>> unfinished_motions();
  // The highest number of a motion of the device; 0: it had none.
  Result<std::uint64_t> last_motion(std::string_view device);
  Result<Head> head();
  // Computes all hashes again. `noted`: a head of before, that must still be part of the chain.
  Result<Verdict> verify(const std::optional<Head>& noted);

 private:
  explicit Store(Database database) : database_(std::move(database)) {}

  Result<void> check_schema(const std::string& path);
  Result<void> make_schema();
  Result<void> upgrade();
  Result<void> add(const Entry& entry, Head& head);
  Result<std::int64_t> person(std::string_view name);
  static Result<std::vector<StoredEntry>> all_of(Statement& rows);
  Result<std::string> meta(std::string_view key);
  Result<void> set_meta(std::string_view key, std::string_view value);

  Database database_;
};

}  // namespace axisgate::server::journal
