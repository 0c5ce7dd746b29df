// How much each identity may have open at once, so that one program out of control leaves room for the others.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

// Of one identity, over all its connections.
struct LimitsConfig {
  int connections = 512;
  int streams = 2048;
  int calls = 1024;             // in flight, of those with one request and one answer
  int message_bytes = 4 << 20;  // of each request's message
};

// Thread safe. Identities with nothing open are forgotten.
class IdentityLimits {
 public:
  enum class Kind { call, stream };

  explicit IdentityLimits(const LimitsConfig& config) : limits_{config.calls, config.streams} {}

  // queue_full, with when to try again, where `who` has as many open as one may.
  Result<void> check(const std::string& who, Kind kind) const;

  // One that is open; gives its place back when the last copy is gone. The limits outlive it.
  using Place = std::shared_ptr<void>;
  // Beyond the limit, too: it is check() that refuses.
  Place take(const std::string& who, Kind kind);

  std::size_t identities() const;  // with something open

 private:
  using Open = std::map<std::string, std::array<int, 2>>;  // by identity and Kind

  void leave(Open::iterator identity, Kind kind);

  const std::array<int, 2> limits_;  // by Kind
  mutable std::mutex mutex_;
  Open open_;
};

}  // namespace axisgate::server
