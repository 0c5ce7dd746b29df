// SQLite, as far as the journal needs it.
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

// The statements of one connection that nobody uses now: to compile one takes longer than to run it. Not thread safe.
class KeptStatements {
 public:
  // As many as an append runs, and some more.
  static constexpr std::size_t kMost = 32;

  KeptStatements() = default;
  ~KeptStatements();
  KeptStatements(const KeptStatements&) = delete;
  KeptStatements& operator=(const KeptStatements&) = delete;

  // Null: none of this text is kept.
  sqlite3_stmt* take(std::string_view sql);
  void give_back(sqlite3_stmt* statement);

 private:
  std::map<std::string, sqlite3_stmt*, std::less<>> kept_;
};

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
  struct GiveBack {
    KeptStatements* kept;
    void operator()(sqlite3_stmt* statement) const { kept->give_back(statement); }
  };
  Statement(sqlite3_stmt* statement, KeptStatements& kept) : statement_(statement, {&kept}) {}

  std::unique_ptr<sqlite3_stmt, GiveBack> statement_;
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
  std::unique_ptr<KeptStatements> kept_ = std::make_unique<KeptStatements>();  // its place stays when this is moved
};

}  // namespace axisgate::server::journal
