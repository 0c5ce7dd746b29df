#include "server/front/request_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace axisgate::front {
namespace {

constexpr std::size_t kPrefixBytes = 5;

bool is_known(std::string_view encoding) { return encoding == "gzip" || encoding == "deflate"; }

std::size_t number_in(std::string_view prefix) {
  std::size_t length = 0;
  for (const char c : prefix.substr(1)) length = length << 8 | static_cast<unsigned char>(c);
  return length;
}

Reply unreadable() {
  return {.code = kInvalidArgument, .message = "the request holds a compressed message that cannot be unpacked"};
}

}  // namespace

RequestBody::Inflater::Inflater() {
  constexpr int kGzipOrDeflate = 15 + 32;
  ::inflateInit2(&stream, kGzipOrDeflate);
}

RequestBody::Inflater::~Inflater() { ::inflateEnd(&stream); }

RequestBody::RequestBody(std::string_view encoding, std::size_t message_bytes, HeldBytes& all)
    : unpacks_(is_known(encoding)),
      unknown_encoding_(unpacks_ || encoding.empty() || encoding == "identity" ? "" : encoding),
      message_bytes_(message_bytes),
      unpacked_(all) {}

std::optional<Reply> RequestBody::take(std::string_view bytes, std::string& out) {
  while (!bytes.empty()) {
    if (prefix_.size() < kPrefixBytes) {
      const std::size_t size = std::min(kPrefixBytes - prefix_.size(), bytes.size());
      prefix_.append(bytes.substr(0, size));
      bytes.remove_prefix(size);
      if (prefix_.size() < kPrefixBytes) break;
      if (auto refusal = begin_message()) return refusal;
      if (!inflater_) out.append(prefix_);
    }
    const std::string_view piece = bytes.substr(0, left_);
    bytes.remove_prefix(piece.size());
    left_ -= piece.size();
    if (!inflater_) {
      out.append(piece);
    } else if (auto refusal = unpack(piece)) {
      return refusal;
    }
    if (left_ > 0) break;
    if (auto refusal = end_message(out)) return refusal;
  }
  return std::nullopt;
}

std::optional<Reply> RequestBody::begin_message() {
  left_ = number_in(prefix_);
  if (left_ > message_bytes_) {
    return Reply{.code = kResourceExhausted,
                 .message = fmt::format("a message of this request has {} bytes; the daemon takes {} at most", left_,
                                        message_bytes_)};
  }
  // An empty message needs no unpacking, but some clients mark it as compressed.
  if (left_ == 0 && prefix_[0] == 1) prefix_[0] = 0;
  if (prefix_[0] == 0) return std::nullopt;
  if (!unknown_encoding_.empty()) {
    return Reply{.code = kUnimplemented,
                 .message =
                     "the request is compressed in a way that the daemon does not know; it knows gzip and "
                     "deflate"};
  }
  if (prefix_[0] != 1 || !unpacks_) {
    return Reply{.code = kInvalidArgument, .message = "the request is no series of gRPC's messages"};
  }
  inflater_ = std::make_unique<Inflater>();
  return std::nullopt;
}

std::optional<Reply> RequestBody::unpack(std::string_view packed) {
  z_stream& stream = inflater_->stream;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib's pointer is not const
  stream.avail_in = static_cast<uInt>(packed.size());
  std::array<char, 16 * 1024> piece{};
  do {
    if (inflater_->ended) return stream.avail_in > 0 ? std::optional(unreadable()) : std::nullopt;
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    const int code = ::inflate(&stream, Z_NO_FLUSH);
    if (code == Z_BUF_ERROR) return std::nullopt;  // the rest is still to come
    if (code != Z_OK && code != Z_STREAM_END) return unreadable();
    inflater_->ended = code == Z_STREAM_END;
    const std::size_t size = piece.size() - stream.avail_out;
    if (message_.size() + size > message_bytes_) {
      return Reply{.code = kResourceExhausted,
                   .message = fmt::format("a message of this request is longer than {} bytes, unpacked; the daemon "
                                          "takes no more",
                                          message_bytes_)};
    }
    if (!unpacked_.take(counted(message_.size() + size) - counted(message_.size()))) {
      return Reply{.code = kResourceExhausted,
                   .message = "too many long requests are on their way at the same time (try again in 1 s)"};
    }
    message_.append(piece.data(), size);
    cost_ += size;
  } while (stream.avail_in > 0 || stream.avail_out == 0);
  return std::nullopt;
}

std::optional<Reply> RequestBody::end_message(std::string& out) {
  prefix_.clear();
  if (!inflater_) return std::nullopt;
  const bool whole = inflater_->ended;
  inflater_.reset();
  if (!whole) return unreadable();
  given_out_ += counted(message_.size());
  out.append(with_prefix(std::exchange(message_, {})));
  return std::nullopt;
}

std::string with_prefix(std::string_view message) {
  std::string body(1, '\0');
  for (int shift = 24; shift >= 0; shift -= 8) body.push_back(static_cast<char>(message.size() >> shift & 0xff));
  body.append(message);
  return body;
}

std::optional<std::string_view> only_message(std::string_view body) {
  if (body.size() < kPrefixBytes || body.size() - kPrefixBytes != number_in(body.substr(0, kPrefixBytes))) {
    return std::nullopt;
  }
  return body.substr(kPrefixBytes);
}

}  // namespace axisgate::front
