#include "clients/cpp/src/failure.h"

#include <fmt/format.h>
#include <google/rpc/status.pb.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "clients/cpp/src/hints.h"

namespace axisgate::client {
namespace {

// Start of gRPC's text for a call that never had a connection. Another text only makes an outcome unknown.
constexpr std::string_view kNeverConnected = "failed to connect to all addresses";
constexpr std::string_view kLookFirst = "look at the stage before you repeat the request";

template <class Kind>
[[noreturn]] void throw_as(ErrorParts parts) {
  throw Kind(std::move(parts));
}

struct KindRow {
  std::string_view reason;
  void (*raise)(ErrorParts);
};

// Reasons whose error is not plainly Refused.
constexpr KindRow kKinds[] = {
    {"OUTSIDE_TRAVEL", throw_as<OutsideTravel>},
    {"NOT_HOMED", throw_as<NotHomed>},
    {"LEASE_HELD", throw_as<LeaseHeld>},
    {"LEASE_LOST", throw_as<LeaseLost>},
    {"STOPPED_BY", throw_as<StoppedBy>},
    {"NOT_ALLOWED", throw_as<NotAllowed>},
    {"UNAUTHENTICATED", throw_as<NotAllowed>},
    {"LINK_DOWN", throw_as<Unavailable>},
    {"NOT_SENT", throw_as<Unavailable>},
    {"REPLY_TIMED_OUT", throw_as<Unavailable>},
    {"LINE_FAULT", throw_as<Unavailable>},
    {"COMPLETION_OUTSTANDING", throw_as<Unavailable>},
    {"JOURNAL_UNAVAILABLE", throw_as<Unavailable>},
    {"DAEMON_ENDING", throw_as<Unavailable>},
    {"STOPPED", throw_as<Stopped>},
    {"TARGET_NOT_REACHED", throw_as<MotionFailed>},
    {"OUTCOME_UNKNOWN", throw_as<OutcomeUnknown>},
    {"REQUEST_MEMORY_LOST", throw_as<OutcomeUnknown>},
};

// Reasons that the daemon may give before it compares the request's id with earlier requests.
constexpr std::string_view kBeforeMemory[] = {"INVALID_REQUEST", "UNKNOWN_DEVICE", "UNKNOWN_AXIS",
                                              "QUEUE_FULL",      "NOT_ALLOWED",    "UNAUTHENTICATED",
                                              "LEASE_LOST",      "INTERNAL",       "REQUEST_ID_REUSED"};

struct CodeRow {
  grpc::StatusCode code;
  std::string_view name;
  // Reason of a call that the daemon refuses before it can send a problem. RESOURCE_EXHAUSTED has none: gRPC also
  // reports it for an answer that is too long, after the request has acted.
  std::string_view early = "";
};

constexpr CodeRow kCodes[] = {
    {grpc::OK, "OK"},
    {grpc::CANCELLED, "CANCELLED"},
    {grpc::UNKNOWN, "UNKNOWN"},
    {grpc::INVALID_ARGUMENT, "INVALID_ARGUMENT"},
    {grpc::DEADLINE_EXCEEDED, "DEADLINE_EXCEEDED"},
    {grpc::NOT_FOUND, "NOT_FOUND"},
    {grpc::ALREADY_EXISTS, "ALREADY_EXISTS"},
    {grpc::PERMISSION_DENIED, "PERMISSION_DENIED", "NOT_ALLOWED"},
    {grpc::UNAUTHENTICATED, "UNAUTHENTICATED", "UNAUTHENTICATED"},
    {grpc::RESOURCE_EXHAUSTED, "RESOURCE_EXHAUSTED"},
    {grpc::FAILED_PRECONDITION, "FAILED_PRECONDITION"},
    {grpc::ABORTED, "ABORTED"},
    {grpc::OUT_OF_RANGE, "OUT_OF_RANGE"},
    {grpc::UNIMPLEMENTED, "UNIMPLEMENTED", "UNIMPLEMENTED"},
    {grpc::INTERNAL, "INTERNAL"},
    {grpc::UNAVAILABLE, "UNAVAILABLE"},
    {grpc::DATA_LOSS, "DATA_LOSS"},
};

const CodeRow& code_row(grpc::StatusCode code) {
  const auto found = std::ranges::find(kCodes, code, &CodeRow::code);
  return found == std::end(kCodes) ? kCodes[grpc::UNKNOWN] : *found;
}

std::optional<v1::Problem> problem_in(const grpc::Status& status) {
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) return std::nullopt;
  v1::Problem problem;
  for (const google::protobuf::Any& detail : details.details()) {
    if (detail.UnpackTo(&problem)) return problem;
  }
  return std::nullopt;
}

}  // namespace

Failure::Failure(const grpc::Status& status)
    : code(status.error_code()), text(status.error_message()), problem(problem_in(status)) {}

std::string Failure::reason() const {
  return problem ? reason_name(problem->reason()) : std::string(code_row(code).early);
}

bool Failure::lost() const { return !problem && code_row(code).early.empty(); }

bool Failure::never_sent() const { return lost() && text.starts_with(kNeverConnected); }

bool Failure::passing() const { return lost() || code == grpc::UNAVAILABLE; }

bool Failure::decides_repeat() const {
  return !passing() && std::ranges::find(kBeforeMemory, reason()) == std::end(kBeforeMemory);
}

std::string reason_name(v1::Reason reason) {
  constexpr std::string_view prefix = "REASON_";
  const std::string& name = v1::Reason_Name(reason);
  return name.empty() ? fmt::format("REASON {}", static_cast<int>(reason)) : name.substr(prefix.size());
}

ErrorParts to_parts(const v1::Problem& problem, std::string code) {
  const auto axis = problem.has_axis() ? std::optional<int>(problem.axis()) : std::nullopt;
  return {reason_name(problem.reason()), problem.message(), with_functions(problem.hint(), axis), axis, problem.sent(),
          problem.wire_reply(),          std::move(code)};
}

void throw_by_reason(ErrorParts parts) {
  const auto found = std::ranges::find(kKinds, parts.reason, &KindRow::reason);
  if (found != std::end(kKinds)) found->raise(std::move(parts));
  throw Refused(std::move(parts));
}

void throw_error(const Failure& failure, const std::string& target) {
  const std::string code(code_row(failure.code).name);
  if (failure.problem) throw_by_reason(to_parts(*failure.problem, code));
  if (!failure.lost()) throw_by_reason({.reason = failure.reason(), .message = failure.text, .code = code});
  if (failure.never_sent()) throw_unavailable(failure, target);
  throw_look_first(fmt::format("the answer of the daemon at {} was lost: {}", target, failure.text), code);
}

void throw_unavailable(const Failure& failure, const std::string& target) {
  throw Unavailable({.reason = "UNAVAILABLE",
                     .message = fmt::format("no daemon answers at {}: {}", target, failure.text),
                     .hint = "start axisgated, or set AXISGATE_TARGET to its address",
                     .code = std::string(code_row(failure.code).name)});
}

void throw_look_first(std::string message, std::string code) {
  throw OutcomeUnknown({.reason = "OUTCOME_UNKNOWN",
                        .message = std::move(message),
                        .hint = std::string(kLookFirst),
                        .code = std::move(code)});
}

void throw_undelivered(const Unavailable& error) {
  throw OutcomeUnknown({.reason = error.reason(),
                        .message = "the stop was not delivered: " + error.message(),
                        .hint = "press the emergency stop at the device",
                        .code = error.code()});
}

}  // namespace axisgate::client
