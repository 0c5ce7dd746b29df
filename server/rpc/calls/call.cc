#include "server/rpc/calls/call.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "server/events/wall_time.h"
#include "server/rpc/calls/bearer.h"
#include "server/rpc/calls/session.h"

namespace axisgate::rpc {
namespace {

using server::WallTime;

constexpr const char* kAuthorization = "authorization";

std::optional<std::string_view> find(const grpc::ServerContextBase& call, grpc::string_ref name) {
  const auto found = call.client_metadata().find(name);
  if (found == call.client_metadata().end()) return std::nullopt;
  return std::string_view(found->second.data(), found->second.size());
}

std::optional<TimePoint> call_deadline(const grpc::CallbackServerContext& call) {
  if (call.deadline() == WallTime::max()) return std::nullopt;
  return server::to_monotonic(call.deadline());
}

std::optional<TimePoint> not_after(const v1::CallContext& context) {
  if (!context.has_not_after()) return std::nullopt;
  // Bounded, so that a time in the far future does not overflow nanoseconds.
  constexpr std::int64_t kSecondsMax = 4'000'000'000;
  const std::int64_t seconds = std::clamp<std::int64_t>(context.not_after().seconds(), 0, kSecondsMax);
  const auto since_epoch = std::chrono::seconds(seconds) + std::chrono::nanoseconds(context.not_after().nanos());
  return server::to_monotonic(WallTime(std::chrono::duration_cast<WallTime::duration>(since_epoch)));
}

}  // namespace

api::Credential credential_of(const grpc::ServerContextBase& call) {
  std::string who = peer_of(call).who;
  std::string session = session_in(find(call, kSessionHeader), who);
  if (auto token = token_in(find(call, kAuthorization))) {
    return {.token = std::move(token), .session = std::move(session)};
  }
  return {.who = std::move(who), .session = std::move(session)};
}

front::Peer peer_of(const grpc::ServerContextBase& call) {
  return {.who = std::string(find(call, front::kCallerHeader).value_or("")),
          .source = std::string(find(call, front::kSourceHeader).value_or(""))};
}

api::Call to_call(const grpc::CallbackServerContext& call) {
  return {.credential = credential_of(call), .deadline = call_deadline(call)};
}

api::Call to_call(api::Credential credential, std::optional<TimePoint> deadline, const v1::CallContext& context) {
  return {.credential = std::move(credential),
          .deadline = deadline,
          .request_id = context.request_id(),
          .not_after = not_after(context),
          .lease_token = context.lease_token(),
          .device_epoch = context.device_epoch(),
          .frame_epoch = context.frame_epoch(),
          .request_memory = context.request_memory()};
}

api::Call to_call(const grpc::CallbackServerContext& call, const v1::CallContext& context, bool validate_only) {
  api::Call made = to_call(credential_of(call), call_deadline(call), context);
  made.validate_only = validate_only;
  return made;
}

}  // namespace axisgate::rpc
