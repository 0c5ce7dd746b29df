#include "server/rpc/calls/status.h"

#include <google/protobuf/util/time_util.h>
#include <google/rpc/error_details.pb.h>
#include <google/rpc/status.pb.h>

#include <chrono>

namespace axisgate::rpc {
namespace {

google::rpc::ErrorInfo to_info(const v1::Problem& problem, Reason reason) {
  google::rpc::ErrorInfo info;
  info.set_reason(std::string(name(reason)));
  info.set_domain("axisgate");
  auto& metadata = *info.mutable_metadata();
  metadata.insert(problem.metadata().begin(), problem.metadata().end());
  if (problem.has_axis()) metadata["axis"] = std::to_string(problem.axis());
  if (!problem.sent().empty()) metadata["sent"] = problem.sent();
  if (!problem.wire_reply().empty()) metadata["wire_reply"] = problem.wire_reply();
  if (!problem.hint().empty()) metadata["hint"] = problem.hint();
  return info;
}

google::rpc::RetryInfo to_info(Duration retry_after) {
  google::rpc::RetryInfo info;
  *info.mutable_retry_delay() =
      google::protobuf::util::TimeUtil::NanosecondsToDuration(std::chrono::nanoseconds(retry_after).count());
  return info;
}

}  // namespace

std::optional<Duration> retry_after(Reason reason) {
  if (reason != Reason::queue_full) return std::nullopt;
  return std::chrono::seconds(1);
}

grpc::StatusCode code_of(Reason reason) {
  switch (reason) {
    case Reason::invalid_request:
    case Reason::unknown_axis:
    case Reason::unknown_unit:
    case Reason::not_representable:
    case Reason::malformed_line:
    case Reason::unknown_command:
    case Reason::incomplete_transaction:
      return grpc::StatusCode::INVALID_ARGUMENT;
    case Reason::unknown_device:
    case Reason::not_found:
      return grpc::StatusCode::NOT_FOUND;
    case Reason::out_of_range:
    case Reason::outside_travel:
    case Reason::too_fast:
    case Reason::compacted:
      return grpc::StatusCode::OUT_OF_RANGE;
    case Reason::axis_busy:
    case Reason::not_excited:
    case Reason::limit_detected:
    case Reason::emergency_stopped:
    case Reason::device_error:
    case Reason::wrong_mode:
    case Reason::stale_setpoint:
    case Reason::position_unknown:
    case Reason::device_refused:
    case Reason::identity_mismatch:
    case Reason::lease_held:
    case Reason::lease_lost:
    case Reason::outside_lease:
    case Reason::stopped_by:
    case Reason::epoch_passed:
    case Reason::not_homed:
    case Reason::unexplained:
    case Reason::request_memory_lost:
    case Reason::stop_unconfirmed:
    case Reason::wrong_job_state:
    case Reason::setup_changed:
    case Reason::not_confirmed:
      return grpc::StatusCode::FAILED_PRECONDITION;
    case Reason::link_down:
    case Reason::not_sent:
    case Reason::reply_timed_out:
    case Reason::line_fault:
    case Reason::completion_outstanding:
    case Reason::journal_unavailable:
    case Reason::daemon_ending:
      return grpc::StatusCode::UNAVAILABLE;
    case Reason::deadline_passed:
      return grpc::StatusCode::DEADLINE_EXCEEDED;
    case Reason::request_id_reused:
      return grpc::StatusCode::ALREADY_EXISTS;
    case Reason::unauthenticated:
      return grpc::StatusCode::UNAUTHENTICATED;
    case Reason::not_allowed:
      return grpc::StatusCode::PERMISSION_DENIED;
    case Reason::queue_full:
      return grpc::StatusCode::RESOURCE_EXHAUSTED;
    case Reason::stopped:
    case Reason::target_not_reached:
      return grpc::StatusCode::ABORTED;
    case Reason::unspecified:
    case Reason::outcome_unknown:
      return grpc::StatusCode::UNKNOWN;
    case Reason::internal:
      return grpc::StatusCode::INTERNAL;
  }
  return grpc::StatusCode::INTERNAL;
}

grpc::Status to_status(const Problem& problem, const proto::Metadata& metadata) {
  const grpc::StatusCode code = code_of(problem.reason);
  const v1::Problem detail = proto::to_proto(problem, metadata);
  google::rpc::Status status;
  status.set_code(code);
  status.set_message(problem.message);
  status.add_details()->PackFrom(detail);
  status.add_details()->PackFrom(to_info(detail, problem.reason));
  if (const auto wait = retry_after(problem.reason)) status.add_details()->PackFrom(to_info(*wait));
  return {code, problem.message, status.SerializeAsString()};
}

grpc::Status to_status(const api::StreamEnd& end) {
  if (!end.problem) return grpc::Status::OK;
  if (!end.resume) return to_status(*end.problem);
  return to_status(*end.problem, {{"resume_revision", std::to_string(*end.resume)}});
}

}  // namespace axisgate::rpc
