#include "server/journal/store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <random>
#include <utility>

#include "server/journal/chain.h"
#include "server/journal/conditions.h"

namespace axisgate::server::journal {
namespace {

constexpr std::int64_t kSchema = 3, kWithoutRequests = 1, kWithoutFacts = 2;
static_assert(static_cast<int>(EntryKind::link_changed) == 30, "the index entry_of_line is of these");
constexpr const char* kMakeSchema = R"(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE entry(
  number INTEGER PRIMARY KEY, time_us INTEGER NOT NULL, boot_time_us INTEGER NOT NULL, kind INTEGER NOT NULL,
  device TEXT NOT NULL, person INTEGER NOT NULL, motion INTEGER NOT NULL, body TEXT NOT NULL, hash BLOB NOT NULL) STRICT;
CREATE INDEX entry_by_time ON entry(time_us);
CREATE INDEX entry_by_motion ON entry(device, motion);
)";
constexpr const char* kMakeLineIndex = "CREATE INDEX entry_of_line ON entry(kind, device) WHERE kind = 30;";
constexpr std::string_view kColumns =
    "SELECT number, time_us, boot_time_us, kind, device, person, motion, body, hash, "
    "coalesce((SELECT name FROM person WHERE id = person), '') FROM entry ";

std::int64_t micros(WallTime time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}

std::int64_t micros(TimePoint time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}

std::string random_epoch() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

Row row_of(const Statement& row) {
  return {row.integer(0), row.integer(1), row.integer(2), row.integer(3),
          row.bytes(4),   row.integer(5), row.integer(6), row.bytes(7)};
}

Hash stored_hash(const Statement& row) {
  Hash hash{};
  const std::string_view bytes = row.bytes(8);
  if (bytes.size() == hash.size()) std::ranges::copy(bytes, hash.begin());
  return hash;
}

std::string text_of(const Hash& hash) { return fmt::format("{:02x}", fmt::join(hash, "")); }

// Returns all zeros if the text is not a hash.
Hash hash_in(std::string_view text) {
  Hash hash{};
  for (std::size_t i = 0; i < hash.size() && 2 * i + 2 <= text.size(); ++i) {
    std::from_chars(text.data() + 2 * i, text.data() + 2 * i + 2, hash[i], 16);
  }
  return hash;
}

std::string body_of_dropped(const Head& through) {
  return fmt::format(R"({{"through":{},"hash":"{}"}})", through.number, text_of(through.hash));
}

StoredEntry entry_of(const Statement& row) {
  StoredEntry stored{.number = row.integer(0), .entry = {}, .hash = stored_hash(row)};
  stored.entry.time = WallTime(std::chrono::microseconds(row.integer(1)));
  stored.entry.boot_time = TimePoint(std::chrono::microseconds(row.integer(2)));
  stored.entry.kind = static_cast<EntryKind>(row.integer(3));
  stored.entry.device = row.bytes(4);
  stored.entry.motion = static_cast<std::uint64_t>(row.integer(6));
  stored.entry.body = row.bytes(7);
  stored.entry.who = row.bytes(9);
  return stored;
}

}  // namespace

tl::expected<Store, Unopened> Store::open(const std::string& path, const char* vfs) {
  auto database = Database::open(path, Database::Access::write, vfs);
  if (!database) return tl::unexpected(database.error());
  Store store(*std::move(database));
  if (const auto good = store.check_schema(path); !good) {
    return tl::unexpected(Unopened{good.error(), store.database_.is_damaged()});
  }
  return store;
}

Result<Store> Store::open_to_read(const std::string& path) {
  auto database = Database::open(path, Database::Access::read);
  if (!database) return tl::unexpected(database.error().problem);
  return Store(*std::move(database));
}

Result<void> Store::check_schema(const std::string& path) {
  auto version = database_.prepare("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  if (const auto row = version->step(); !row) return tl::unexpected(row.error());
  const std::int64_t found = version->integer(0);
  version->reset();
  if (found == 0) return make_schema();
  if (found == kSchema) return {};
  if (found == kWithoutRequests || found == kWithoutFacts) return upgrade(found);
  return fail(Reason::internal,
              fmt::format("journal {}: a newer version of axisgated has written it (schema {}, this one knows {})",
                          path, found, kSchema),
              "install that version again, or move the file away: a new journal then begins");
}

Result<void> Store::make_schema() {
  const std::string sql = fmt::format(
      "BEGIN IMMEDIATE; {} {} {} {} {} INSERT INTO meta VALUES('epoch', '{}'); PRAGMA user_version = {}; COMMIT;",
      PersonTable::kMake, kMakeSchema, kMakeLineIndex, RequestTable::kMake, FactTable::kMake, random_epoch(), kSchema);
  return database_.run(sql.c_str());
}

Result<void> Store::upgrade(std::int64_t from) {
  const std::string requests =
      from == kWithoutRequests ? fmt::format("{} {}", kMakeLineIndex, RequestTable::kMake) : "";
  const std::string sql =
      fmt::format("BEGIN IMMEDIATE; {} {} PRAGMA user_version = {}; COMMIT;", requests, FactTable::kMake, kSchema);
  return database_.run(sql.c_str());
}

Result<void> Store::append(std::span<const Record> records, const FactChange& facts) {
  if (auto begun = database_.run("BEGIN IMMEDIATE"); !begun) return begun;
  // Writes the facts first: they were kept before the records came, and a record may erase a name that they contain.
  Result<void> done = FactTable(database_).change(facts);
  Result<Head> last = head();
  if (!last) done = tl::unexpected(last.error());
  RequestTable requests(database_);
  for (const Record& record : records) {
    if (done) done = add(record.entry, *last);
    if (done) done = requests.change(record.requests);
    if (done && record.erased_person != 0) done = erase(record.erased_person);
  }
  if (done) done = database_.run("COMMIT");
  if (!done) (void)database_.run("ROLLBACK");
  return done;
}

Result<void> Store::erase(std::int64_t person) {
  return FactTable(database_).erase(person).and_then([&] { return PersonTable(database_).erase(person); });
}

Result<void> Store::add(const Entry& entry, Head& head) {
  const auto who = PersonTable(database_).number_of(entry.who);
  if (!who) return tl::unexpected(who.error());
  const Row row{head.number + 1,
                micros(entry.time),
                micros(entry.boot_time),
                static_cast<std::int64_t>(entry.kind),
                entry.device,
                *who,
                static_cast<std::int64_t>(entry.motion),
                entry.body};
  head.hash = hash_of(head.hash, row);
  head.number = row.number;
  auto insert = database_.prepare("INSERT INTO entry VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  if (!insert) return tl::unexpected(insert.error());
  insert->bind(1, row.number).bind(2, row.time_us).bind(3, row.boot_time_us).bind(4, row.kind).bind(5, row.device);
  insert->bind(6, row.person).bind(7, row.motion).bind(8, row.body);
  insert->bind_bytes(9, {reinterpret_cast<const char*>(head.hash.data()), head.hash.size()});
  return insert->step().map([](bool) {});
}

// Returns the last dropped row. If none was dropped, its number is 0 and its hash is the one before the first row.
Result<Head> Store::dropped() {
  auto epoch = this->epoch();
  if (!epoch) return tl::unexpected(epoch.error());
  const auto text = meta("dropped");
  if (!text) return tl::unexpected(text.error());
  Head head{*epoch, 0, hash_of_epoch(*epoch)};
  const std::size_t space = text->find(' ');
  if (space == std::string::npos) return head;
  head.number = std::strtoll(text->c_str(), nullptr, 10);
  head.hash = hash_in(std::string_view(*text).substr(space + 1));
  return head;
}

Result<bool> Store::is_beyond(const StoreBounds& bounds, WallTime newest_in_segment, WallTime now) {
  if (now - newest_in_segment > bounds.age) return true;
  auto used = database_.prepare(
      "SELECT (p.page_count - f.freelist_count) * s.page_size FROM pragma_page_count p, pragma_freelist_count f, "
      "pragma_page_size s");
  if (!used) return tl::unexpected(used.error());
  return used->step().map([&](bool) { return used->integer(0) > bounds.bytes; });
}

Result<bool> Store::drop_old(const StoreBounds& bounds, const Entry& as_of) {
  const auto before = dropped();
  if (!before) return tl::unexpected(before.error());
  const auto newest = head();
  if (!newest) return tl::unexpected(newest.error());
  const std::int64_t end = before->number + kSegment;
  if (newest->number < end + kSegment) return false;
  const auto last = read({.before = end + 1}, 1);
  if (!last) return tl::unexpected(last.error());
  if (last->empty() || last->front().number != end) return false;  // verify() reports the cause
  const auto beyond = is_beyond(bounds, last->front().entry.time, as_of.time);
  if (!beyond || !*beyond) return beyond;
  return drop({before->epoch, end, last->front().hash}, as_of).map([] { return true; });
}

Result<void> Store::drop(const Head& through, const Entry& as_of) {
  Entry entry = as_of;
  entry.kind = EntryKind::entries_dropped;
  entry.body = body_of_dropped(through);
  if (auto begun = database_.run("BEGIN IMMEDIATE"); !begun) return begun;
  Result<void> done = set_meta("dropped", fmt::format("{} {}", through.number, text_of(through.hash)));
  Result<Head> last = head();
  if (done && !last) done = tl::unexpected(last.error());
  if (done) done = add(entry, *last);
  if (done) done = database_.run(fmt::format("DELETE FROM entry WHERE number <= {}", through.number).c_str());
  if (done) done = database_.run("COMMIT");
  if (!done) (void)database_.run("ROLLBACK");
  return done;
}

Result<std::vector<StoredEntry>> Store::read(const Filter& filter, std::size_t limit) {
  const Conditions conditions = conditions_of(filter);
  auto rows = database_.prepare(fmt::format("{}{}ORDER BY number {} LIMIT {}", kColumns, conditions.sql(),
                                            filter.oldest_first ? "ASC" : "DESC", limit));
  if (!rows) return tl::unexpected(rows.error());
  conditions.bind(*rows);
  return all_of(*rows);
}

Result<std::vector<StoredEntry>> Store::all_of(Statement& rows) {
  std::vector<StoredEntry> found;
  while (true) {
    const auto row = rows.step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return found;
    found.push_back(entry_of(rows));
  }
}

Result<std::vector<StoredEntry>> Store::unfinished_motions() {
  using enum EntryKind;
  auto rows = database_.prepare(fmt::format(
      "{}AS begun WHERE kind = {} AND number > coalesce((SELECT max(number) FROM entry WHERE kind = {}), 0) AND NOT "
      "EXISTS (SELECT 1 FROM entry WHERE device = begun.device AND motion = begun.motion AND kind = {}) ORDER BY "
      "number",
      kColumns, static_cast<int>(motion_requested), static_cast<int>(daemon_started), static_cast<int>(motion_ended)));
  if (!rows) return tl::unexpected(rows.error());
  return all_of(*rows);
}

// Looks at the newest start or end of the daemon. None is left if the start of the run was old enough to be dropped:
// the run then counts as ended uncleanly.
Result<bool> Store::ended_uncleanly() {
  using enum EntryKind;
  auto newest = database_.prepare(fmt::format(
      "SELECT EXISTS (SELECT 1 FROM entry) AND NOT coalesce((SELECT kind = {1} FROM entry WHERE kind IN ({0}, {1}) "
      "ORDER BY number DESC LIMIT 1), 0)",
      static_cast<int>(daemon_started), static_cast<int>(daemon_ended)));
  if (!newest) return tl::unexpected(newest.error());
  return newest->step().map([&](bool) { return newest->integer(0) != 0; });
}

Result<std::uint64_t> Store::last_motion(std::string_view device) {
  auto highest = database_.prepare("SELECT coalesce(max(motion), 0) FROM entry WHERE device = ?");
  if (!highest) return tl::unexpected(highest.error());
  return highest->bind(1, device).step().map([&](bool) { return static_cast<std::uint64_t>(highest->integer(0)); });
}

Result<std::string> Store::meta(std::string_view key) {
  auto found = database_.prepare("SELECT value FROM meta WHERE key = ?");
  if (!found) return tl::unexpected(found.error());
  return found->bind(1, key).step().map([&](bool there) { return there ? std::string(found->bytes(0)) : ""; });
}

Result<void> Store::set_meta(std::string_view key, std::string_view value) {
  auto set = database_.prepare("INSERT OR REPLACE INTO meta VALUES(?, ?)");
  if (!set) return tl::unexpected(set.error());
  return set->bind(1, key).bind(2, value).step().map([](bool) {});
}

Result<std::string> Store::epoch() { return meta("epoch"); }

// The stored value is "BOOT MICROSECONDS". The time between two boots does not count, so requests are remembered
// longer.
Result<Duration> Store::boot_offset(std::string_view boot, TimePoint now) {
  const auto known = meta("boot");
  if (!known) return tl::unexpected(known.error());
  const std::size_t space = known->rfind(' ');
  if (!boot.empty() && space != std::string::npos && std::string_view(*known).substr(0, space) == boot) {
    return std::chrono::microseconds(std::strtoll(known->c_str() + space, nullptr, 10));
  }
  auto latest = database_.prepare("SELECT coalesce(max(lived_us), 0) FROM request");
  if (!latest) return tl::unexpected(latest.error());
  if (const auto row = latest->step(); !row) return tl::unexpected(row.error());
  const std::int64_t offset = latest->integer(0) - micros(now);
  const auto kept = set_meta("boot", fmt::format("{} {}", boot, offset));
  return kept.map([&] { return Duration(std::chrono::microseconds(offset)); });
}

Result<Head> Store::head() {
  auto epoch = this->epoch();
  if (!epoch) return tl::unexpected(epoch.error());
  auto last = database_.prepare(fmt::format("{}ORDER BY number DESC LIMIT 1", kColumns));
  if (!last) return tl::unexpected(last.error());
  const auto there = last->step();
  if (!there) return tl::unexpected(there.error());
  if (!*there) return Head{*epoch, 0, hash_of_epoch(*epoch)};
  return Head{*std::move(epoch), last->integer(0), stored_hash(*last)};
}

// Checks the rows first, because a fault in a row is reported with its number.
Result<Verdict> Store::verify(const std::optional<Head>& noted) {
  auto verdict = verify_chain(noted);
  if (!verdict || verdict->first_bad) return verdict;
  auto complaint = first_complaint();
  if (!complaint) return tl::unexpected(complaint.error());
  verdict->fault = *std::move(complaint);
  return verdict;
}

// Returns SQLite's first complaint about the file; empty if there is none. A quick_check would not compare indices with
// rows.
Result<std::string> Store::first_complaint() {
  auto check = database_.prepare("PRAGMA integrity_check(1)");
  if (!check) return tl::unexpected(check.error());
  return check->step().map([&](bool there) {
    const std::string_view text = there ? check->bytes(0) : "ok";
    return text == "ok" ? std::string() : std::string(text);
  });
}

Result<Verdict> Store::verify_chain(const std::optional<Head>& noted) {
  const auto begin = dropped();
  if (!begin) return tl::unexpected(begin.error());
  auto rows = database_.prepare(fmt::format("{}ORDER BY number", kColumns));
  if (!rows) return tl::unexpected(rows.error());
  Verdict verdict;
  Hash hash = begin->hash;
  std::int64_t expected = begin->number + 1;
  std::string said_dropped;
  const auto bad = [&](std::int64_t number, std::string fault) {
    verdict.first_bad = number;
    verdict.fault = std::move(fault);
    return verdict;
  };
  if (noted && noted->epoch != begin->epoch) return bad(1, "the head is of another journal: a new one has begun since");
  if (noted && noted->number < begin->number) {
    return bad(noted->number, "it is no longer kept, so that the noted head shows nothing: note a new one");
  }
  if (noted && noted->number == begin->number && noted->hash != begin->hash) {
    return bad(noted->number, "it was changed before it was dropped, since the head was noted");
  }
  while (true) {
    const auto there = rows->step();
    if (!there) return tl::unexpected(there.error());
    if (!*there) break;
    const Row row = row_of(*rows);
    if (row.number != expected) return bad(expected, "it is missing");
    hash = hash_of(hash, row);
    if (hash != stored_hash(*rows)) return bad(row.number, "it or its place was changed");
    if (noted && noted->number == row.number && noted->hash != hash) {
      return bad(row.number, "it or a row before it was changed since the head was noted, and all hashes with it");
    }
    if (row.kind == static_cast<std::int64_t>(EntryKind::entries_dropped)) said_dropped = row.body;
    ++verdict.rows;
    ++expected;
  }
  if (begin->number != 0 && said_dropped != body_of_dropped(*begin)) {
    return bad(begin->number, "it was removed, and no entry says that it was dropped");
  }
  if (noted && noted->number >= expected) return bad(expected, "it is missing: the noted head comes after it");
  return verdict;
}

}  // namespace axisgate::server::journal
