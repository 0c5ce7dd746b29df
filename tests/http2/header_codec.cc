#include "tests/http2/header_codec.h"

#include <algorithm>
#include <cstdint>
#include <new>

namespace axisgate::front {
namespace {

constexpr std::size_t kTableBytes = 4096;  // default table size of both ends (RFC 9113, 6.5.2)

// Casts away const: nghttp2 takes constant data by non-const pointers.
std::uint8_t* as_bytes(std::string_view text) {
  return reinterpret_cast<std::uint8_t*>(
      const_cast<char*>(text.data()));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

std::string_view as_text(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

// Appends a string literal (RFC 7541, 5.1), with a prefix of 7 bits and no Huffman code.
void append_text(std::string& block, std::string_view text) {
  constexpr std::size_t kPrefix = 127;
  std::size_t size = text.size();
  block.push_back(static_cast<char>(std::min(size, kPrefix)));
  if (size >= kPrefix) {
    for (size -= kPrefix; size >= 128; size /= 128) block.push_back(static_cast<char>(size % 128 + 128));
    block.push_back(static_cast<char>(size));
  }
  block.append(text);
}

}  // namespace

HeaderDecoder::HeaderDecoder() {
  nghttp2_hd_inflater* inflater = nullptr;
  if (nghttp2_hd_inflate_new(&inflater) != 0) throw std::bad_alloc();
  inflater_.reset(inflater);
}

std::optional<Headers> HeaderDecoder::decode(std::string_view block, std::size_t bytes_max) {
  Headers headers;
  std::size_t bytes = 0;
  while (true) {
    nghttp2_nv pair{};
    int flags = 0;
    const ssize_t taken =
        nghttp2_hd_inflate_hd2(inflater_.get(), &pair, &flags, as_bytes(block), block.size(), 1 /* the last piece */);
    if (taken < 0) return std::nullopt;
    block.remove_prefix(static_cast<std::size_t>(taken));
    if ((flags & NGHTTP2_HD_INFLATE_EMIT) != 0) {
      bytes += pair.namelen + pair.valuelen;
      if (bytes > bytes_max) return std::nullopt;
      headers.push_back(
          {std::string(as_text(pair.name, pair.namelen)), std::string(as_text(pair.value, pair.valuelen))});
    }
    if ((flags & NGHTTP2_HD_INFLATE_FINAL) != 0) break;
    if ((flags & NGHTTP2_HD_INFLATE_EMIT) == 0 && block.empty()) break;
  }
  nghttp2_hd_inflate_end_headers(inflater_.get());
  return headers;
}

HeaderEncoder::HeaderEncoder() {
  nghttp2_hd_deflater* deflater = nullptr;
  if (nghttp2_hd_deflate_new(&deflater, kTableBytes) != 0) throw std::bad_alloc();
  deflater_.reset(deflater);
}

std::string HeaderEncoder::encode(const Headers& headers) {
  std::vector<nghttp2_nv> pairs;
  pairs.reserve(headers.size());
  for (const Header& header : headers) {
    pairs.push_back(
        {as_bytes(header.name), as_bytes(header.value), header.name.size(), header.value.size(), NGHTTP2_NV_FLAG_NONE});
  }
  std::string block(nghttp2_hd_deflate_bound(deflater_.get(), pairs.data(), pairs.size()), '\0');
  const ssize_t size =
      nghttp2_hd_deflate_hd(deflater_.get(), as_bytes(block), block.size(), pairs.data(), pairs.size());
  if (size < 0) throw std::bad_alloc();
  block.resize(static_cast<std::size_t>(size));
  return block;
}

std::string encode_without_table(const Headers& headers) {
  std::string block;
  for (const Header& header : headers) {
    block.push_back('\0');  // literal without indexing, new name (RFC 7541, 6.2.2)
    append_text(block, header.name);
    append_text(block, header.value);
  }
  return block;
}

}  // namespace axisgate::front
