// What is remembered of requests by their ids, in the journal's file. It is outside the chain, since it is forgotten
// again.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "server/journal/database.h"

namespace axisgate::server::journal {

struct RememberedRequest {
  std::string identity, id;  // whose, and the caller's own text
  std::int64_t number = 0;   // ascends, also over restarts
  Duration lived{};          // when it came, by RequestMemory's clock
  std::string digest{};      // of what was requested
  std::string device{};
  bool moves = false;        // what it does is a motion
  std::uint64_t motion = 0;  // 0: not made yet, or none
  bool open = true;          // what became of it is not known yet
  std::string answer{};      // answers.h; of an open motion: as it was made
};

// How the memory changes; written together with an entry.
struct RequestChange {
  RememberedRequest request{};  // without an id: none
  bool forget = false;          // this request
  std::int64_t forgotten = 0;   // all up to this number
};

struct RequestsOnFile {
  std::vector<RememberedRequest> requests;  // by number
  std::int64_t forgotten = 0;               // all up to this number
};

// Of one Database, which outlives it. Not thread safe.
class RequestTable {
 public:
  static constexpr const char* kMake = R"(
CREATE TABLE request(
  identity TEXT NOT NULL, id TEXT NOT NULL, number INTEGER NOT NULL, lived_us INTEGER NOT NULL, digest BLOB NOT NULL,
  device TEXT NOT NULL, moves INTEGER NOT NULL, motion INTEGER NOT NULL, open INTEGER NOT NULL, answer TEXT NOT NULL,
  PRIMARY KEY(identity, id)) STRICT, WITHOUT ROWID;
CREATE INDEX request_by_number ON request(number);
)";

  explicit RequestTable(Database& database) : database_(database) {}

  Result<void> change(const RequestChange& change);
  Result<RequestsOnFile> read();

 private:
  Result<void> put(const RememberedRequest& request);
  Result<void> forget(const RememberedRequest& request);
  Result<void> forget_through(std::int64_t number);

  Database& database_;
};

}  // namespace axisgate::server::journal
