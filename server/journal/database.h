// SQLite, as far as the journal needs it.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "server/events/wall_time.h"

namespace axisgate::server::journal {

// One query of one Database, which outlives it. Not thread safe.
class Statement {
 public:
  // Counts from 1, as SQLite's parameters. What is bound stays until it is bound again. Times are microseconds since
  // 1970.
  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, WallTime time);
  Statement& bind_bytes(int parameter, std::string_view bytes);

  // Whether there is a row. internal, with SQLite's own words.
  Result<bool> step();
  // Of the row; columns count from 0. The views hold until the next step().
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  std::string_view bytes(int column) const;
  WallTime time(int column) const { return WallTime(std::chrono::microseconds(integer(column))); }

  // Ready to run again.
  void reset() { sqlite3_reset(statement_.get()); }

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}

  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

// Why a file could not be opened.
struct Unopened {
  Problem problem;       // internal, with SQLite's own words
  bool damaged = false;  // what is there is no database, or no whole one
};

// One connection to a file. Not thread safe; several connections to one file are.
class Database {
 public:
  enum class Access { write, read };

  // With Access::write, made where it is missing: for the daemon's user alone, and each commit is on the disk when it
  // has returned. `vfs`: the name of a registered sqlite3_vfs that has the file; null: the system's.
  static tl::expected<Database, Unopened> open(const std::string& path, Access access, const char* vfs = nullptr);

  // Of a statement that answers nothing, or several of them.
  Result<void> run(const char* sql);
  // SQL has one function more: identity_of(TEXT), as server::identity_of().
  Result<Statement> prepare(std::string_view sql);
  // Leaves nothing in the file `-wal`, which has all that was written lately. Does not wait: internal where somebody
  // reads meanwhile.
  Result<void> empty_log();

  // Whether that is why the last of these failed.
  bool is_damaged() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  explicit Database(sqlite3* database) : database_(database) {}

  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace axisgate::server::journal
