#include "server/journal/database.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <system_error>

#include "server/access/access.h"
#include "server/access/synced_file.h"
#include "server/limits.h"

namespace axisgate::server::journal {
namespace {

tl::unexpected<Problem> failed(sqlite3* database, std::string_view what) {
  const char* path = database == nullptr ? nullptr : sqlite3_db_filename(database, "main");
  return fail(Reason::internal,
              fmt::format("journal {}: {} failed: {}", path == nullptr ? "" : path, what, sqlite3_errmsg(database)),
              "look at the disk's free space and rights");
}

// Describes why a file could not be opened. SQLite knows the path of a database only after opening it, and its message
// says only that it could not open a file.
Problem unopened(sqlite3* database, const std::string& path) {
  const int error = sqlite3_system_errno(database);
  return {.reason = Reason::internal,
          .message = fmt::format("{}: {}{}", path, sqlite3_errmsg(database),
                                 error == 0 ? "" : ": " + std::generic_category().message(error)),
          .hint = "let the daemon's user write in its state directory, which STATE_DIRECTORY names"};
}

void identity_function(sqlite3_context* context, int, sqlite3_value** arguments) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_value_text(arguments[0]));
  const std::string identity = identity_of(text == nullptr ? "" : text);
  sqlite3_result_text64(context, identity.data(), identity.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
}

}  // namespace

KeptStatements::~KeptStatements() {
  for (const auto& [sql, statement] : kept_) sqlite3_finalize(statement);
}

sqlite3_stmt* KeptStatements::take(std::string_view sql) {
  const auto found = kept_.find(sql);
  return found == kept_.end() ? nullptr : kept_.extract(found).mapped();
}

// Resets the statement before keeping it: a statement that is not reset would block the emptying of the log, and its
// bound values may contain somebody's name.
void KeptStatements::give_back(sqlite3_stmt* statement) {
  sqlite3_reset(statement);
  sqlite3_clear_bindings(statement);
  const bool kept = kept_.size() < kMost && kept_.try_emplace(sqlite3_sql(statement), statement).second;
  if (!kept) sqlite3_finalize(statement);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), parameter, value);
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  return *this;
}

Statement& Statement::bind(int parameter, WallTime time) {
  const auto since = std::chrono::floor<std::chrono::microseconds>(time.time_since_epoch());
  return bind(parameter, std::int64_t{since.count()});
}

Statement& Statement::bind_bytes(int parameter, std::string_view bytes) {
  sqlite3_bind_blob64(statement_.get(), parameter, bytes.data(), bytes.size(), SQLITE_TRANSIENT);
  return *this;
}

Result<bool> Statement::step() {
  switch (sqlite3_step(statement_.get())) {
    case SQLITE_ROW:
      return true;
    case SQLITE_DONE:
      return false;
    default:
      return failed(sqlite3_db_handle(statement_.get()), sqlite3_sql(statement_.get()));
  }
}

std::string_view Statement::bytes(int column) const {
  const auto* begin = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return {begin, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

tl::expected<Database, Unopened> Database::open(const std::string& path, Access access, const char* vfs) {
  if (access == Access::write && vfs == nullptr) {
    // SQLite would follow a link, and would create a file that others may read.
    const Result<Descriptor> file = open_state_file(path, O_RDWR | O_CREAT);
    if (!file) return tl::unexpected(Unopened{file.error()});
  }
  const int create = vfs == nullptr ? 0 : SQLITE_OPEN_CREATE;
  const int flags = access == Access::write ? SQLITE_OPEN_READWRITE | create : SQLITE_OPEN_READONLY;
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &opened, flags | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_NOFOLLOW, vfs);
  Database database(opened);
  if (code != SQLITE_OK) return tl::unexpected(Unopened{unopened(opened, path)});
  sqlite3_busy_timeout(opened, static_cast<int>(kDatabaseLockWait.count()));
  sqlite3_create_function_v2(opened, "identity_of", 1, SQLITE_UTF8 | SQLITE_DETERMINISTIC, nullptr, identity_function,
                             nullptr, nullptr, nullptr);
  if (access == Access::read) return database;
  // In WAL mode only FULL syncs at each commit. Without secure_delete the bytes of deleted rows stay in the file. An
  // append touches few pages, so half a MiB of cache is enough.
  constexpr const char* kPragmas =
      "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA secure_delete = ON; PRAGMA cache_size = -512;";
  if (auto set = database.run(kPragmas); !set) {
    return tl::unexpected(Unopened{set.error(), database.is_damaged()});
  }
  return database;
}

bool Database::is_damaged() const {
  const int code = sqlite3_errcode(database_.get()) & 0xFF;
  return code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
}

Result<void> Database::run(const char* sql) {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) return failed(database_.get(), sql);
  return {};
}

Result<void> Database::empty_log() {
  sqlite3_busy_timeout(database_.get(), 0);
  const int code = sqlite3_wal_checkpoint_v2(database_.get(), nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
  sqlite3_busy_timeout(database_.get(), static_cast<int>(kDatabaseLockWait.count()));
  if (code != SQLITE_OK) return failed(database_.get(), "emptying its log");
  return {};
}

Result<Statement> Database::prepare(std::string_view sql) {
  sqlite3_stmt* statement = kept_->take(sql);
  if (statement != nullptr) return Statement(statement, *kept_);
  if (sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr) != SQLITE_OK) {
    return failed(database_.get(), sql);
  }
  return Statement(statement, *kept_);
}

}  // namespace axisgate::server::journal
