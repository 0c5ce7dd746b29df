// What comes with every request: who calls, and what the caller says beside the request itself.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "device/core/problem.h"
#include "device/core/time.h"

namespace axisgate::api {

// Who calls, as a door knows it before anything was checked.
struct Credential {
  std::string who{};                   // by the connection: "unix alice", "cert alice", "tcp 127.0.0.1:39482"
  std::optional<std::string> token{};  // goes before `who`; empty text: something that is no token
  bool needs_token = false;            // without a token nobody may call so
  std::string session{};               // stage::Use::session
};

// As in Motion.who, without a check: "unix alice", "token night-scan".
std::string name_of(const Credential& credential);

// Plain values of one call. Times are monotonic.
struct Call {
  Credential credential{};
  std::optional<TimePoint> deadline{};   // until when the caller waits; nothing: for as long as it takes
  std::string request_id{};              // the caller's own; may be empty
  std::optional<TimePoint> not_after{};  // nothing: as the request's kind has it
  std::string lease_token{};             // as its holder was given it; empty: none
  std::uint64_t device_epoch = 0;        // that the caller has in mind; 0: any
  std::uint64_t frame_epoch = 0;         // likewise
  bool validate_only = false;            // every check, and nothing is sent
  std::string digest{};                  // of what is requested, the same for the same; with a request_id
  std::string request_memory{};          // of a repeat: RequestMemory::mark() before the first time; else empty
};

// Called once, from any thread, also before the member that took it has returned. Dropped where the device's line is
// closed before.
template <class Outcome>
using Answer = std::function<void(Result<Outcome>)>;

// What is wrong with a request as it is written, where something is.
template <class Request>
std::optional<Problem> fault_of(const Result<Request>& written) {
  return written ? std::nullopt : std::optional(written.error());
}

}  // namespace axisgate::api
