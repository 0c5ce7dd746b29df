#include "server/front/replies.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <chrono>
#include <utility>

namespace axisgate::front {
namespace {

const Headers kHead = {{":status", "200"}, {"content-type", "application/grpc"}};

// Encodes grpc-message as gRPC's protocol requires: all but printable ASCII, and the percent sign, as a code.
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

// Encodes without padding, as gRPC requires of headers whose names end with -bin.
std::string base64(std::string_view bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // EVP adds a zero
  const int size =
      ::EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  while (text.ends_with('=')) text.pop_back();
  return text;
}

}  // namespace

Headers answer_head() { return kHead; }

Headers trailers_of(const Reply& reply) {
  Headers headers = {{"grpc-status", std::to_string(reply.code)}};
  if (reply.code == 0) return headers;
  headers.push_back({"grpc-message", percent_encoded(reply.message)});
  if (!reply.details.empty()) headers.push_back({"grpc-status-details-bin", base64(reply.details)});
  if (reply.retry_after) {
    headers.push_back({"grpc-retry-pushback-ms",
                       std::to_string(std::chrono::ceil<std::chrono::milliseconds>(*reply.retry_after).count())});
  }
  return headers;
}

Headers answer_without_body(const Reply& reply) {
  Headers headers = kHead;
  for (Header& header : trailers_of(reply)) headers.push_back(std::move(header));
  return headers;
}

}  // namespace axisgate::front
