#include "server/journal/request_table.h"

#include <fmt/format.h>

#include <utility>

namespace axisgate::server::journal {
namespace {

std::int64_t micros(Duration time) { return std::chrono::duration_cast<std::chrono::microseconds>(time).count(); }

RememberedRequest request_of(const Statement& row) {
  return {.identity = std::string(row.bytes(0)),
          .id = std::string(row.bytes(1)),
          .number = row.integer(2),
          .lived = std::chrono::microseconds(row.integer(3)),
          .digest = std::string(row.bytes(4)),
          .device = std::string(row.bytes(5)),
          .moves = row.integer(6) != 0,
          .motion = static_cast<std::uint64_t>(row.integer(7)),
          .open = row.integer(8) != 0,
          .answer = std::string(row.bytes(9))};
}

}  // namespace

Result<void> RequestTable::change(const RequestChange& change) {
  if (change.forgotten > 0) {
    if (auto done = forget_through(change.forgotten); !done) return done;
  }
  if (change.request.id.empty()) return {};
  return change.forget ? forget(change.request) : put(change.request);
}

Result<void> RequestTable::put(const RememberedRequest& request) {
  auto insert = database_.prepare("INSERT OR REPLACE INTO request VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  if (!insert) return tl::unexpected(insert.error());
  insert->bind(1, request.identity).bind(2, request.id).bind(3, request.number).bind(4, micros(request.lived));
  insert->bind_bytes(5, request.digest).bind(6, request.device).bind(7, std::int64_t{request.moves});
  insert->bind(8, static_cast<std::int64_t>(request.motion)).bind(9, std::int64_t{request.open});
  return insert->bind(10, request.answer).step().map([](bool) {});
}

// Leaves a later request with the same id untouched.
Result<void> RequestTable::forget(const RememberedRequest& request) {
  auto remove = database_.prepare("DELETE FROM request WHERE identity = ? AND id = ? AND number = ?");
  if (!remove) return tl::unexpected(remove.error());
  return remove->bind(1, request.identity).bind(2, request.id).bind(3, request.number).step().map([](bool) {});
}

Result<void> RequestTable::forget_through(std::int64_t number) {
  return database_.run(fmt::format("DELETE FROM request WHERE number <= {0} AND NOT open;"
                                   "INSERT OR REPLACE INTO meta VALUES('requests_forgotten', '{0}');",
                                   number)
                           .c_str());
}

Result<RequestsOnFile> RequestTable::read() {
  RequestsOnFile found;
  auto forgotten = database_.prepare("SELECT CAST(value AS INTEGER) FROM meta WHERE key = 'requests_forgotten'");
  if (!forgotten) return tl::unexpected(forgotten.error());
  const auto there = forgotten->step();
  if (!there) return tl::unexpected(there.error());
  if (*there) found.forgotten = forgotten->integer(0);
  auto rows = database_.prepare("SELECT * FROM request ORDER BY number");
  if (!rows) return tl::unexpected(rows.error());
  while (true) {
    const auto row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return found;
    found.requests.push_back(request_of(*rows));
  }
}

}  // namespace axisgate::server::journal
