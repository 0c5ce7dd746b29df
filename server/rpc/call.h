// What every handler asks of a call first: which device is meant, who calls, and until when the asking counts.
#pragma once

#include <grpcpp/server_context.h>

#include <string>
#include <string_view>

#include "axisgate/v1/common.pb.h"
#include "device/core/problem.h"
#include "device/stage/stage_controller.h"
#include "server/access/access.h"
#include "server/gateway.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

std::string device_name(const server::Device& device);                               // "devices/{d}"
std::string motion_name(std::string_view device_of_config, stage::MotionId motion);  // "devices/{d}/motions/{id}"

// invalid_request where the name is not "devices/{d}", unknown_device where no device is called so.
Result<server::Device*> find_device(const server::Gateway& gateway, std::string_view name);

struct MotionName {
  server::Device* device = nullptr;
  stage::MotionId id = 0;
};
// invalid_request where the name is not "devices/{d}/motions/{id}", unknown_device.
Result<MotionName> find_motion_name(const server::Gateway& gateway, std::string_view name);

// The motion, or not_found. On the device's strand.
Result<stage::Motion> find_motion(const stage::StageController& controller, stage::MotionId id);

// Contexts of requests that arrive now; invalid_request for a request_id that is too long or not printable ASCII.
// All end at the call's own gRPC deadline at the latest.
//
// A motion may start until its not_after; without one, for 5 s.
Result<stage::RequestContext> motion_context(const grpc::CallbackServerContext& call, const api::CallContext& context,
                                             const server::Access& access);
// Any other request that changes something counts until its not_after; without one, for 20 s or, with a gRPC deadline,
// until that.
Result<stage::RequestContext> mutation_context(const grpc::CallbackServerContext& call,
                                               const api::CallContext& context);
// A stop is never refused for its context, and asks for no not_after: it is waited for as long as for a question.
stage::RequestContext stop_context(const grpc::CallbackServerContext& call, const api::CallContext& context);
// A question counts until the call's deadline, or for 20 s.
stage::RequestContext question_context(const grpc::CallbackServerContext& call);

}  // namespace axisgate::rpc
