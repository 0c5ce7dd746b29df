// Whether two requests ask for the same.
#pragma once

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

namespace axisgate::proto {

// 32 bytes: SHA-256 of the message without its context, in one form: 1 um and 1000 nm are the same.
std::string digest_of(const google::protobuf::Message& request);

// Of what came before and the next message: of a stream.
std::string digest_of(std::string_view before, const google::protobuf::Message& next);

}  // namespace axisgate::proto
