// The tokens of leases. Each is a number that grows, and callers get it sealed, so that nobody can guess one.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate::server {

using LeaseToken = std::uint64_t;  // 0 is none

// Later tokens are greater, over restarts of the daemon too. Thread safe.
class LeaseTokens {
 public:
  // The number, most significant byte first, and the seal.
  static constexpr std::size_t kSealBytes = 16, kSealedBytes = sizeof(LeaseToken) + kSealBytes;

  // No lease ever has this one.
  static constexpr LeaseToken kUnknown = ~LeaseToken{0};

  // `generation` is another, greater one for every start of the daemon.
  explicit LeaseTokens(std::uint32_t generation);

  LeaseToken next() { return next_++; }

  // The bytes for the holder: the number and 128 bits that only this run of the daemon can make. They are a secret.
  std::string seal(LeaseToken token) const;
  // 0 for no bytes. lease_lost: the bytes are no token of this run. Compares in constant time.
  Result<LeaseToken> open(std::string_view sealed) const;

 private:
  using Seal = std::array<unsigned char, kSealBytes>;
  Seal seal_of(std::string_view number) const;

  const std::uint32_t generation_;
  std::array<unsigned char, 32> key_{};  // another one for every start
  std::atomic<LeaseToken> next_;
};

}  // namespace axisgate::server
