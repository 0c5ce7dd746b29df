// Limits for each identity, so that one program out of control leaves room for the others.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

// Limits of one identity over all its connections.
struct LimitsConfig {
  int connections = 512;
  int streams = 2048;
  int calls = 1024;             // in flight, with one request and one answer
  int message_bytes = 4 << 20;  // of each request message
};

// Thread safe. Identities with nothing open are forgotten.
class IdentityLimits {
 public:
  enum class Kind { call, stream };

  explicit IdentityLimits(const LimitsConfig& config) : limits_{config.calls, config.streams} {}

  // Fails with queue_full, and says when to try again, if `who` has reached the limit.
  Result<void> check(const std::string& who, Kind kind) const;

  // A Place counts one open call or stream until its last copy is destroyed. The limits must outlive it.
  using Place = std::shared_ptr<void>;
  // Never refuses, even beyond the limit: check() does that.
  Place take(const std::string& who, Kind kind);

  std::size_t identities() const;  // with anything open

 private:
  using Open = std::map<std::string, std::array<int, 2>>;  // by identity and Kind

  void leave(Open::iterator identity, Kind kind);

  const std::array<int, 2> limits_;  // by Kind
  mutable std::mutex mutex_;
  Open open_;
};

}  // namespace axisgate::server
