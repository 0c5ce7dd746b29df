// The part of SQLite that the journal needs.
#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "server/events/wall_time.h"

namespace axisgate::server::journal {

// Compiled statements of one connection that are not in use: compiling a statement takes longer than running it. Not
// thread safe.
class KeptStatements {
 public:
  // Slightly more than the number of statements that an append runs.
  static constexpr std::size_t kMost = 32;

  KeptStatements() = default;
  ~KeptStatements();
  KeptStatements(const KeptStatements&) = delete;
  KeptStatements& operator=(const KeptStatements&) = delete;

  // Returns null if no statement with this text is kept.
  sqlite3_stmt* take(std::string_view sql);
  void give_back(sqlite3_stmt* statement);

 private:
  std::map<std::string, sqlite3_stmt*, std::less<>> kept_;
};

// One query of a Database, which must outlive it. Not thread safe.
class Statement {
 public:
  // Parameters count from 1, as in SQLite. A bound value stays until another is bound. Times are microseconds since
  // 1970.
  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, WallTime time);
  Statement& bind_bytes(int parameter, std::string_view bytes);

  // Reports whether there is another row. Fails with internal and SQLite's own message.
  Result<bool> step();
  // Columns of the current row count from 0. The views stay valid until the next step().
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  std::string_view bytes(int column) const;
  WallTime time(int column) const { return WallTime(std::chrono::microseconds(integer(column))); }

  // Makes the statement ready to run again.
  void reset() { sqlite3_reset(statement_.get()); }

 private:
  friend class Database;
  struct GiveBack {
    KeptStatements* kept;
    void operator()(sqlite3_stmt* statement) const { kept->give_back(statement); }
  };
  Statement(sqlite3_stmt* statement, KeptStatements& kept) : statement_(statement, {&kept}) {}

  std::unique_ptr<sqlite3_stmt, GiveBack> statement_;
};

// Reason why a file could not be opened.
struct Unopened {
  Problem problem;       // internal, with SQLite's own message
  bool damaged = false;  // the file is not a database, or is incomplete
};

// One connection to a file. Not thread safe, but several connections to one file may be used at the same time.
class Database {
 public:
  enum class Access { write, read };

  // Opens a file. With Access::write, a missing file is created with access for the daemon's user alone, and each
  // commit is on the disk when it returns. `vfs`: name of a registered sqlite3_vfs that contains the file; null: the
  // system's.
  static tl::expected<Database, Unopened> open(const std::string& path, Access access, const char* vfs = nullptr);

  // Runs one or several statements that return no rows.
  Result<void> run(const char* sql);
  // SQL has an additional function, identity_of(TEXT), which is server::identity_of().
  Result<Statement> prepare(std::string_view sql);
  // Empties the file `-wal`, which contains everything that was written recently. Does not wait: fails with internal if
  // somebody is reading.
  Result<void> empty_log();

  // Reports whether a damaged file made the last call fail.
  bool is_damaged() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  explicit Database(sqlite3* database) : database_(database) {}

  std::unique_ptr<sqlite3, Close> database_;
  // Keeps its address when the database is moved.
  std::unique_ptr<KeptStatements> kept_ = std::make_unique<KeptStatements>();
};

}  // namespace axisgate::server::journal
