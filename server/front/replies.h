// How a call is answered that gRPC does not see: by frames of our own, as gRPC's protocol over HTTP/2 has them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/front/desk.h"

namespace axisgate::front {

// Before the first message of an answer.
std::string head_frame(std::uint32_t stream);
// The status, which ends the stream. `alone`: no head came before.
std::string ending_frame(std::uint32_t stream, const Reply& reply, bool alone);

// The message in the DATA of a call with one request: what is behind its five bytes, unpacked by zlib where the client
// packed it. Nothing where it is not whole, or more than `bytes_max`.
std::optional<std::string> message_in(std::string_view data, std::size_t bytes_max);

}  // namespace axisgate::front
