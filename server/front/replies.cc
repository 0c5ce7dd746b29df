#include "server/front/replies.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <zlib.h>

#include <utility>

#include "server/front/frames.h"

namespace axisgate::front {
namespace {

constexpr std::size_t kMessagePrefix = 5;  // of a message: whether it is packed, and its length
constexpr auto kEnd =
    static_cast<std::uint8_t>(static_cast<int>(FrameFlag::end_headers) | static_cast<int>(FrameFlag::end_stream));

const Headers kHead = {{":status", "200"}, {"content-type", "application/grpc"}};

// As gRPC's protocol wants grpc-message: what is not printable ASCII, and the percent sign, by its code.
std::string percent_encoded(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    const bool plain = c >= ' ' && c <= '~' && c != '%';
    if (plain) {
      encoded.push_back(c);
    } else {
      encoded += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return encoded;
}

// Without padding, as gRPC wants headers whose names end with -bin.
std::string base64(std::string_view bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // and a zero that EVP adds
  const int size =
      ::EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  while (text.ends_with('=')) text.pop_back();
  return text;
}

Headers trailers(const Reply& reply) {
  Headers headers = {{"grpc-status", std::to_string(reply.code)}};
  if (reply.code == 0) return headers;
  headers.push_back({"grpc-message", percent_encoded(reply.message)});
  if (!reply.details.empty()) headers.push_back({"grpc-status-details-bin", base64(reply.details)});
  return headers;
}

std::optional<std::string> unpacked(std::string_view packed, std::size_t bytes_max) {
  z_stream stream{};
  constexpr int kGzipOrDeflate = 15 + 32;
  if (::inflateInit2(&stream, kGzipOrDeflate) != Z_OK) return std::nullopt;
  std::string text(bytes_max, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib's pointer is not const
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  const int end = ::inflate(&stream, Z_FINISH);
  text.resize(stream.total_out);
  ::inflateEnd(&stream);
  if (end != Z_STREAM_END) return std::nullopt;
  return text;
}

}  // namespace

std::string head_frame(std::uint32_t stream) {
  return frame(FrameType::headers, static_cast<std::uint8_t>(FrameFlag::end_headers), stream,
               encode_without_table(kHead));
}

std::string ending_frame(std::uint32_t stream, const Reply& reply, bool alone) {
  Headers headers = alone ? kHead : Headers();
  for (Header& header : trailers(reply)) headers.push_back(std::move(header));
  return frame(FrameType::headers, kEnd, stream, encode_without_table(headers));
}

std::optional<std::string> message_in(std::string_view data, std::size_t bytes_max) {
  if (data.size() < kMessagePrefix || data.size() - kMessagePrefix != number_at(data, 1)) return std::nullopt;
  const std::string_view message = data.substr(kMessagePrefix);
  if (message.size() > bytes_max) return std::nullopt;
  return data[0] == 0 ? std::string(message) : unpacked(message, bytes_max);
}

}  // namespace axisgate::front
