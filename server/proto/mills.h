// Mills and their jobs, as callers read them.
#pragma once

#include <cstdint>
#include <string_view>

#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/mill.pb.h"
#include "device/core/problem.h"
#include "server/api/mill/mill_subjects.h"

namespace axisgate::proto {

// Of the mill with that name in the configuration. `clock`: by which its times are shown.
v1::Job to_proto(std::string_view mill, const rml1::Job& job, const server::Moment& clock);
v1::Job to_proto(const api::CurrentJob& job);
v1::SendingState to_sending_state(rml1::SenderState state);
v1::JobPlaceRange to_proto(const rml1::PlaceRange& range);
v1::RunOn to_proto(const rml1::RunOn& run_on);
// Of what runs; without a job where nothing does.
v1::RunningJob to_proto(const api::CurrentRun& run);
v1::Mill to_proto(const api::MillState& state);
// As it is among all devices.
v1::Device device_of(const api::MillState& state);

rml1::JobSetup to_setup(const v1::JobSetup& proto);
// invalid_request, where it names no act.
Result<api::HandRequest> to_hand_request(const v1::OperateMillRequest& request);
// Of the first message of a job. invalid_request, where it has both a tool and parts, an unknown streaming, or a
// workpiece without size.
Result<api::JobToSend> to_job(const v1::SendJobRequest& request);
// 0 is no line, and the first column.
api::LineToChoose to_line(std::int64_t line, std::int64_t column);
api::JobToRepeat to_repeat(const v1::RepeatJobRequest& request);

}  // namespace axisgate::proto
