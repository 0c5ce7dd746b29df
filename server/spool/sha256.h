// SHA-256 of bytes that arrive in pieces.
#pragma once

#include <openssl/evp.h>

#include <memory>
#include <string>
#include <string_view>

namespace axisgate::server::spool {

class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  // Returns the hash of all added bytes, 64 hexadecimal digits. No bytes may be added afterwards.
  std::string hexadecimal();

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

}  // namespace axisgate::server::spool
