// Comparison of two requests for the same content.
#pragma once

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

namespace axisgate::proto {

// Returns the SHA-256 (32 bytes) of the message without its context, with amounts in one form: 1 um and 1000 nm are the
// same.
std::string digest_of(const google::protobuf::Message& request);

// Returns the digest of a stream of messages: `before` is the digest of all messages before `next`.
std::string digest_of(std::string_view before, const google::protobuf::Message& next);

}  // namespace axisgate::proto
