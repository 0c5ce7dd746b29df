// Reasons for which the front itself closes a connection.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace axisgate::front {

// The set is closed: each value is a label on the metrics page.
enum class Cause {
  handshake_failed,  // TLS: no trusted certificate, another protocol, or not finished in time
  no_call,           // no call was let in within FrontLimits::silence
  frame_unfinished,  // a frame or headers came more slowly than FrontLimits::pace
  over_budget,       // more of something than FrontLimits allows
  protocol_error,    // not HTTP/2, or frames against RFC 9113
};
inline constexpr std::array kCauses = {Cause::handshake_failed, Cause::no_call, Cause::frame_unfinished,
                                       Cause::over_budget, Cause::protocol_error};

constexpr std::string_view name(Cause cause) {
  switch (cause) {
    case Cause::handshake_failed:
      return "handshake_failed";
    case Cause::no_call:
      return "no_call";
    case Cause::frame_unfinished:
      return "frame_unfinished";
    case Cause::over_budget:
      return "over_budget";
    case Cause::protocol_error:
      break;
  }
  return "protocol_error";
}

struct Closing {
  Cause cause = Cause::protocol_error;
  std::string text{};  // for people; contains no text from the client
};

}  // namespace axisgate::front
