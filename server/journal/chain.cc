#include "server/journal/chain.h"

#include <openssl/sha.h>

#include <string>

namespace axisgate::server::journal {
namespace {

void append(std::string& bytes, std::int64_t number) {
  for (int shift = 56; shift >= 0; shift -= 8) {
    bytes += static_cast<char>(static_cast<std::uint64_t>(number) >> shift & 0xFF);
  }
}

// Appends the length before the text, so that two different rows never give the same bytes.
void append(std::string& bytes, std::string_view text) {
  append(bytes, static_cast<std::int64_t>(text.size()));
  bytes += text;
}

Hash sha256(std::string_view bytes) {
  Hash hash;
  ::SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hash.data());
  return hash;
}

}  // namespace

Hash hash_of(const Hash& before, const Row& row) {
  std::string bytes(before.begin(), before.end());
  for (const std::int64_t number : {row.number, row.time_us, row.boot_time_us, row.kind}) append(bytes, number);
  append(bytes, row.device);
  append(bytes, row.person);
  append(bytes, row.motion);
  append(bytes, row.body);
  return sha256(bytes);
}

Hash hash_of_epoch(std::string_view epoch) { return sha256(epoch); }

}  // namespace axisgate::server::journal
