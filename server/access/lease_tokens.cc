#include "server/access/lease_tokens.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <algorithm>
#include <stdexcept>

namespace axisgate::server {
namespace {

constexpr int kByteBits = 8, kGenerationBits = 32;

std::string to_bytes(LeaseToken token) {
  std::string bytes(sizeof(token), '\0');
  for (auto byte = bytes.rbegin(); byte != bytes.rend(); ++byte, token >>= kByteBits) {
    *byte = static_cast<char>(token & 0xFF);
  }
  return bytes;
}

LeaseToken to_number(std::string_view bytes) {
  LeaseToken token = 0;
  for (const char byte : bytes) token = token << kByteBits | static_cast<unsigned char>(byte);
  return token;
}

tl::unexpected<Problem> refused(std::string message) {
  return fail(Reason::lease_lost, std::move(message), "acquire another one: `AcquireLease`");
}

}  // namespace

LeaseTokens::LeaseTokens(std::uint32_t generation) : next_((LeaseToken{generation} << kGenerationBits) + 1) {
  if (RAND_bytes(key_.data(), static_cast<int>(key_.size())) != 1) throw std::runtime_error("no random numbers");
}

LeaseTokens::Seal LeaseTokens::seal_of(std::string_view number) const {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  const auto* made = HMAC(EVP_sha256(), key_.data(), static_cast<int>(key_.size()),
                          reinterpret_cast<const unsigned char*>(number.data()), number.size(), digest.data(), &length);
  if (made == nullptr || length < kSealBytes) throw std::runtime_error("no HMAC-SHA-256");
  Seal seal{};
  std::copy_n(digest.begin(), seal.size(), seal.begin());
  return seal;
}

std::string LeaseTokens::seal(LeaseToken token) const {
  std::string sealed = to_bytes(token);
  const Seal seal = seal_of(sealed);
  return sealed.append(seal.begin(), seal.end());
}

Result<LeaseToken> LeaseTokens::open(std::string_view sealed) const {
  if (sealed.empty()) return LeaseToken{0};
  if (sealed.size() != kSealedBytes) return refused("what was given is no lease token");
  const std::string_view number = sealed.substr(0, sizeof(LeaseToken)), seal = sealed.substr(sizeof(LeaseToken));
  if (CRYPTO_memcmp(seal_of(number).data(), seal.data(), kSealBytes) == 0) return to_number(number);
  return refused(kNoSuchLease);
}

}  // namespace axisgate::server
