// Fencing tokens of leases. Each is an ascending number, which callers receive sealed so that nobody can guess one.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate::server {

using LeaseToken = std::uint64_t;  // 0: none

// Message about a token that no lease has.
inline constexpr const char* kNoSuchLease = "no lease has this token; those of before the daemon's start have ended";

// Later tokens are greater, also over restarts of the daemon. Thread safe.
class LeaseTokens {
 public:
  // A sealed token is the number, most significant byte first, and the seal.
  static constexpr std::size_t kSealBytes = 16, kSealedBytes = sizeof(LeaseToken) + kSealBytes;

  // Token that no lease ever has.
  static constexpr LeaseToken kUnknown = ~LeaseToken{0};

  // `generation` must be greater at every start of the daemon.
  explicit LeaseTokens(std::uint32_t generation);

  LeaseToken next() { return next_++; }

  // Returns the bytes for the holder: the number, and 128 bits that only this run of the daemon can compute. They are
  // secret.
  std::string seal(LeaseToken token) const;
  // Returns the number; 0 if `sealed` is empty. Fails with lease_lost if the bytes are not a token of this run.
  // Compares in constant time.
  Result<LeaseToken> open(std::string_view sealed) const;

 private:
  using Seal = std::array<unsigned char, kSealBytes>;
  Seal seal_of(std::string_view number) const;

  std::array<unsigned char, 32> key_{};  // drawn at every start
  std::atomic<LeaseToken> next_;
};

}  // namespace axisgate::server
