// Hash chain that shows whether a row was changed, removed, added or moved.
#pragma once

#include <cstdint>
#include <string_view>

#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Columns of a row as they are stored.
struct Row {
  std::int64_t number = 0;
  std::int64_t time_us = 0;       // since 1970
  std::int64_t boot_time_us = 0;  // since the machine's boot
  std::int64_t kind = 0;
  std::string_view device;
  std::int64_t person = 0;
  std::int64_t motion = 0;
  std::string_view body;
};

// Returns the SHA-256 hash of a row. For the first row `before` is the hash of the journal's epoch.
Hash hash_of(const Hash& before, const Row& row);
Hash hash_of_epoch(std::string_view epoch);

}  // namespace axisgate::server::journal
