// Remembered requests, by their ids, in the journal's file. They are outside the chain, because old requests are
// deleted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "server/journal/database.h"

namespace axisgate::server::journal {

struct RememberedRequest {
  std::string identity, id;  // identity of the caller, and the id that the caller chose
  std::int64_t number = 0;   // ascends, also after a restart
  Duration lived{};          // time of arrival, by RequestMemory's clock
  std::string digest{};      // digest of the request's content
  std::string device{};
  bool moves = false;        // the request is a motion
  std::uint64_t motion = 0;  // 0: not created yet, or none
  bool open = true;          // the result is not known yet
  std::string answer{};      // see answers.h; for an open motion: its state when it was created
};

// Change of the memory, written together with an entry.
struct RequestChange {
  RememberedRequest request{};  // without an id: none
  bool forget = false;          // delete this request
  std::int64_t forgotten = 0;   // delete all requests up to this number; 0: none
};

struct RequestsOnFile {
  std::vector<RememberedRequest> requests;  // ordered by number
  std::int64_t forgotten = 0;               // all requests up to this number are forgotten
};

// Requests in a Database, which must outlive this object. Not thread safe.
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
