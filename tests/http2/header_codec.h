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

// Each block must pass through, in order: both ends keep a table. Not thread safe.
class HeaderDecoder {
 public:
  HeaderDecoder();

  // Nothing where the block is malformed, or holds more than `bytes_max` of names and values: the table is lost then,
  // and so is the connection.
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

// A block that changes no table, so that it may stand between those of another encoder.
std::string encode_without_table(const Headers& headers);

}  // namespace axisgate::front
