// Data of every call: the caller, and the values that accompany the request itself.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "device/core/problem.h"
#include "device/core/time.h"

namespace axisgate::api {

// A Credential identifies the caller as the door knows it, before any check.
struct Credential {
  std::string who{};                   // name by the connection: "unix alice", "cert alice", "tcp 127.0.0.1:39482"
  std::optional<std::string> token{};  // overrides `who`; an empty text is an invalid token
  bool needs_token = false;            // calls without a token are refused
  std::string session{};               // see use::Use::session
};

// Returns the caller's name as in Caller.name, without any check: "unix alice", "token night-scan".
std::string name_of(const Credential& credential);

// A Call is the data of one call, as plain values. Times are monotonic.
struct Call {
  Credential credential{};
  std::optional<TimePoint> deadline{};   // end of the caller's wait; nullopt: no limit
  std::string request_id{};              // chosen by the caller; may be empty
  std::optional<TimePoint> not_after{};  // nullopt: default of the request's kind
  std::string lease_token{};             // sealed token as its holder received it; empty: none
  std::uint64_t device_epoch = 0;        // device epoch that the caller expects; 0: any
  std::uint64_t frame_epoch = 0;         // frame epoch that the caller expects; 0: any
  bool validate_only = false;            // run every check, but send nothing
  std::string digest{};                  // of the request, equal for equal requests; set with a request_id
  std::string request_memory{};          // for a repeat: RequestMemory::mark() from before the first attempt; else
                                         // empty
};

// An Answer is called once, from any thread, possibly before the member that took it has returned. It is dropped if the
// device's line is closed first.
template <class Outcome>
using Answer = std::function<void(Result<Outcome>)>;

// Returns the problem of a request that could not be read; nullopt if it was read.
template <class Request>
std::optional<Problem> fault_of(const Result<Request>& written) {
  return written ? std::nullopt : std::optional(written.error());
}

}  // namespace axisgate::api
