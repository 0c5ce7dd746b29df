// HPACK (RFC 7541) by nghttp2, for tests that write and read HTTP/2 by hand.
#pragma once

#include <nghttp2/nghttp2.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/front/headers.h"

namespace axisgate::front {

// Decodes header blocks. All blocks must be passed in order, because both ends keep a table. Not thread safe.
class HeaderDecoder {
 public:
  HeaderDecoder();

  // Returns nullopt if the block is malformed or has more than `bytes_max` bytes of names and values. The table is then
  // lost, and the connection with it.
  std::optional<Headers> decode(std::string_view block, std::size_t bytes_max);

 private:
  struct Delete {
    void operator()(nghttp2_hd_inflater* inflater) const { nghttp2_hd_inflate_del(inflater); }
  };
  std::unique_ptr<nghttp2_hd_inflater, Delete> inflater_;
};

class HeaderEncoder {
 public:
  HeaderEncoder();

  std::string encode(const Headers& headers);

 private:
  struct Delete {
    void operator()(nghttp2_hd_deflater* deflater) const { nghttp2_hd_deflate_del(deflater); }
  };
  std::unique_ptr<nghttp2_hd_deflater, Delete> deflater_;
};

// Encodes a block that changes no table, so that it can be sent between blocks of another encoder.
std::string encode_without_table(const Headers& headers);

}  // namespace axisgate::front
