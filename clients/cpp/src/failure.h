// Failed calls and problems, as values and as exceptions. Nothing here waits or sends.
#pragma once

#include <grpcpp/grpcpp.h>

#include <optional>
#include <string>

#include "axisgate/errors.h"
#include "axisgate/v1/common.pb.h"

namespace axisgate::client {

// A Failure is a call that ended without an answer.
struct Failure {
  explicit Failure(const grpc::Status& status);

  // Returns the name of the reason: "OUTSIDE_TRAVEL". Empty if the answer was lost.
  std::string reason() const;
  // Reports whether the answer was lost, so that the request may have acted.
  bool lost() const;
  // Reports whether the request cannot have acted, because there was no connection.
  bool never_sent() const;
  // Reports whether the same request may succeed a moment later.
  bool passing() const;
  // Reports whether the refusal of a repeat means that the first request did not act either.
  bool decides_repeat() const;

  grpc::StatusCode code;
  std::string text;
  std::optional<v1::Problem> problem;  // nullopt if the daemon did not report one
};

// Name of a reason without the prefix of the API; "REASON 99" for a reason that this version does not know.
std::string reason_name(v1::Reason reason);

// The functions below throw the error of a call that failed and is not repeated. `target` is the daemon's address.
[[noreturn]] void throw_error(const Failure& failure, const std::string& target);
// Throws the error of a request that acted nowhere because the daemon did not answer.
[[noreturn]] void throw_unavailable(const Failure& failure, const std::string& target);
// Throws the error of a request that may have acted.
[[noreturn]] void throw_look_first(std::string message, std::string code = {});
// Throws the error of a stop that reached no daemon. It is not Refused: the axes may be moving.
[[noreturn]] void throw_undelivered(const Unavailable& error);

// Returns the parts of the error of a problem. An empty code: it is not the answer to a call.
ErrorParts to_parts(const v1::Problem& problem, std::string code = {});
// Throws the error that the reason of the parts asks for.
[[noreturn]] void throw_by_reason(ErrorParts parts);

}  // namespace axisgate::client
