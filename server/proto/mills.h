// Conversion of mills and their jobs to and from callers' messages.
#pragma once

#include <cstdint>
#include <string_view>

#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/mill.pb.h"
#include "device/core/problem.h"
#include "server/api/mill/mill_subjects.h"

namespace axisgate::proto {

// `mill` is the mill's name in the configuration. `clock` converts the job's times to wall time.
v1::Job to_proto(std::string_view mill, const jobs::Job& job, const server::Moment& clock);
v1::Job to_proto(const api::CurrentJob& job);
v1::SendingState to_sending_state(jobs::SenderState state);
v1::JobPlaceRange to_proto(const jobs::PlaceRange& range);
v1::RunOn to_proto(const jobs::RunOn& run_on);
// Empty message if no job runs.
v1::RunningJob to_proto(const api::CurrentRun& run);
v1::Mill to_proto(const api::MillState& state);
// Returns the mill's entry in the list of all devices.
v1::Device device_of(const api::MillState& state);

jobs::JobSetup to_setup(const v1::JobSetup& proto);
// Fails with invalid_request if the request names no act.
Result<api::HandRequest> to_hand_request(const v1::OperateMillRequest& request);
// Reads the first message of a job. Fails with invalid_request if the job has both a tool and parts, an unknown
// streaming, or a workpiece without a valid size.
Result<api::JobToSend> to_job(const v1::JobHeader& header);
// Returns the digest of the whole request from the digest of its header and the SHA-256 of the job's bytes, so that it
// does not depend on the division into messages.
std::string job_digest(std::string_view header_digest, const std::string& bytes_digest);
// A `line` of 0 means no line; a `column` of 0 means the first one.
api::LineToChoose to_line(std::int64_t line, std::int64_t column);
api::JobToRepeat to_repeat(const v1::RepeatJobRequest& request);

}  // namespace axisgate::proto
