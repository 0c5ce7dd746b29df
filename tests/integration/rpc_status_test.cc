#include <google/rpc/error_details.pb.h>
#include <google/rpc/status.pb.h>
#include <gtest/gtest.h>

#include "axisgate/v1/common.pb.h"
#include "server/rpc/calls/status.h"

namespace axisgate::rpc {
namespace {

TEST(Status, EveryReasonHasTheCodeThatTheApiNames) {
  // Codes typed from the comments in common.proto.
  const std::pair<Reason, grpc::StatusCode> expected[] = {
      {Reason::unspecified, grpc::UNKNOWN},
      {Reason::invalid_request, grpc::INVALID_ARGUMENT},
      {Reason::unknown_device, grpc::NOT_FOUND},
      {Reason::unknown_axis, grpc::INVALID_ARGUMENT},
      {Reason::unknown_unit, grpc::INVALID_ARGUMENT},
      {Reason::out_of_range, grpc::OUT_OF_RANGE},
      {Reason::outside_travel, grpc::OUT_OF_RANGE},
      {Reason::too_fast, grpc::OUT_OF_RANGE},
      {Reason::not_representable, grpc::INVALID_ARGUMENT},
      {Reason::malformed_line, grpc::INVALID_ARGUMENT},
      {Reason::unknown_command, grpc::INVALID_ARGUMENT},
      {Reason::incomplete_transaction, grpc::INVALID_ARGUMENT},
      {Reason::not_found, grpc::NOT_FOUND},
      {Reason::axis_busy, grpc::FAILED_PRECONDITION},
      {Reason::not_excited, grpc::FAILED_PRECONDITION},
      {Reason::limit_detected, grpc::FAILED_PRECONDITION},
      {Reason::emergency_stopped, grpc::FAILED_PRECONDITION},
      {Reason::device_error, grpc::FAILED_PRECONDITION},
      {Reason::wrong_mode, grpc::FAILED_PRECONDITION},
      {Reason::stale_setpoint, grpc::FAILED_PRECONDITION},
      {Reason::position_unknown, grpc::FAILED_PRECONDITION},
      {Reason::device_refused, grpc::FAILED_PRECONDITION},
      {Reason::identity_mismatch, grpc::FAILED_PRECONDITION},
      {Reason::link_down, grpc::UNAVAILABLE},
      {Reason::not_sent, grpc::UNAVAILABLE},
      {Reason::reply_timed_out, grpc::UNAVAILABLE},
      {Reason::line_fault, grpc::UNAVAILABLE},
      {Reason::completion_outstanding, grpc::UNAVAILABLE},
      {Reason::deadline_passed, grpc::DEADLINE_EXCEEDED},
      {Reason::queue_full, grpc::RESOURCE_EXHAUSTED},
      {Reason::stopped, grpc::ABORTED},
      {Reason::target_not_reached, grpc::ABORTED},
      {Reason::outcome_unknown, grpc::UNKNOWN},
      {Reason::compacted, grpc::OUT_OF_RANGE},
      {Reason::internal, grpc::INTERNAL},
      {Reason::lease_held, grpc::FAILED_PRECONDITION},
      {Reason::lease_lost, grpc::FAILED_PRECONDITION},
      {Reason::outside_lease, grpc::FAILED_PRECONDITION},
      {Reason::stopped_by, grpc::FAILED_PRECONDITION},
      {Reason::not_allowed, grpc::PERMISSION_DENIED},
      {Reason::unauthenticated, grpc::UNAUTHENTICATED},
      {Reason::epoch_passed, grpc::FAILED_PRECONDITION},
      {Reason::not_homed, grpc::FAILED_PRECONDITION},
      {Reason::unexplained, grpc::FAILED_PRECONDITION},
      {Reason::journal_unavailable, grpc::UNAVAILABLE},
      {Reason::request_id_reused, grpc::ALREADY_EXISTS},
      {Reason::request_memory_lost, grpc::FAILED_PRECONDITION},
      {Reason::stop_unconfirmed, grpc::FAILED_PRECONDITION},
      {Reason::daemon_ending, grpc::UNAVAILABLE},
      {Reason::wrong_job_state, grpc::FAILED_PRECONDITION},
      {Reason::setup_changed, grpc::FAILED_PRECONDITION},
      {Reason::not_confirmed, grpc::FAILED_PRECONDITION},
  };
  for (const auto& [reason, code] : expected) EXPECT_EQ(code_of(reason), code) << name(reason);
  EXPECT_EQ(std::size(expected), static_cast<std::size_t>(v1::Reason_ARRAYSIZE));
}

TEST(Status, ReasonsHaveTheSameNumberAndNameInTheApi) {
  for (int number = 0; number < v1::Reason_ARRAYSIZE; ++number) {
    const auto reason = static_cast<Reason>(number);
    const std::string in_api = v1::Reason_Name(static_cast<v1::Reason>(number));
    EXPECT_EQ("REASON_" + std::string(name(reason)), in_api);
  }
}

TEST(Status, CarriesProblemAndErrorInfoInItsDetails) {
  const Problem problem{Reason::device_refused, "axis 2 was refused", "excite it", 2, "M:2+P5", "NG\x01"};
  const grpc::Status status = to_status(problem, {{"resume_revision", "7"}});
  EXPECT_EQ(status.error_code(), grpc::FAILED_PRECONDITION);
  EXPECT_EQ(status.error_message(), "axis 2 was refused");
  google::rpc::Status details;
  ASSERT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.code(), 9);
  ASSERT_EQ(details.details_size(), 2);
  EXPECT_EQ(details.details(0).type_url(), "type.googleapis.com/axisgate.v1.Problem");
  v1::Problem detail;
  ASSERT_TRUE(detail.ParseFromString(details.details(0).value()));
  EXPECT_EQ(detail.reason(), v1::REASON_DEVICE_REFUSED);
  EXPECT_EQ(detail.axis(), 2);
  EXPECT_EQ(detail.sent(), "M:2+P5");
  EXPECT_EQ(detail.wire_reply(), "NG\\x01");
  EXPECT_EQ(detail.metadata().at("resume_revision"), "7");
  EXPECT_EQ(details.details(1).type_url(), "type.googleapis.com/google.rpc.ErrorInfo");
  google::rpc::ErrorInfo info;
  ASSERT_TRUE(info.ParseFromString(details.details(1).value()));
  EXPECT_EQ(info.reason(), "DEVICE_REFUSED");
  EXPECT_EQ(info.domain(), "axisgate");
  EXPECT_EQ(info.metadata().at("axis"), "2");
  EXPECT_EQ(info.metadata().at("hint"), "excite it");
}

}  // namespace
}  // namespace axisgate::rpc
