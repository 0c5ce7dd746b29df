#include "server/rpc/desk.h"

#include <fmt/format.h>
#include <grpcpp/support/status.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/stage.pb.h"
#include "device/core/escape.h"
#include "device/link/clock.h"
#include "server/access/access.h"
#include "server/rpc/amounts.h"
#include "server/rpc/bearer.h"
#include "server/rpc/call.h"
#include "server/rpc/method_kinds.h"
#include "server/rpc/status.h"
#include "server/rpc/to_proto.h"
#include "server/rpc/unreadable.h"

namespace axisgate::rpc {
namespace {

using api::RequestKind;
using front::Headers;
using front::Peer;
using front::Reply;
using front::Verdict;

// Callers whom nothing names. They have their limits together, since nothing distinguishes them for certain.
constexpr const char* kAnonymous = "a caller over TCP";

std::string_view method_of(const Headers& headers) { return find(headers, ":path").value_or(""); }

// As far as limits go.
api::Credential credential_for_limits(const Headers& headers, const Peer& peer) {
  if (auto token = token_in(find(headers, "authorization"))) return {.token = std::move(token)};
  const bool anonymous = !peer.needs_token && server::is_anonymous(peer.who);
  return {.who = anonymous ? kAnonymous : peer.who, .needs_token = peer.needs_token};
}

api::Credential credential_of(const Headers& headers, const Peer& peer) {
  if (auto token = token_in(find(headers, "authorization"))) return {.token = std::move(token)};
  return {.who = peer.who, .needs_token = peer.needs_token};
}

Reply to_reply(const grpc::Status& status) {
  return {.code = status.error_code(), .message = status.error_message(), .details = status.error_details()};
}

Problem nothing_left() {
  return {.reason = Reason::queue_full,
          .message =
              "the daemon serves nothing but a stop on this connection: this caller has too many open, or opens them "
              "too fast, or no descriptor is left",
          .hint =
              "close connections that nobody uses, and connect again in 1 s; or have the daemon's limit of open files "
              "raised (ulimit -n, or LimitNOFILE= of its service), or `connections` in [limits] of its "
              "configuration"};
}

Reply no_such_method(std::string_view method) {
  constexpr std::size_t kShown = 100;
  return {.code = grpc::UNIMPLEMENTED,
          .message = fmt::format("{} is no method of this daemon; proto/ has them all", escaped(method, kShown))};
}

// `grpc-timeout`: a number and H, M, S, m, u or n.
std::optional<TimePoint> deadline_of(const Headers& headers) {
  const std::string_view text = find(headers, "grpc-timeout").value_or("");
  constexpr std::string_view kUnits = "HMSmun";
  constexpr std::array<std::int64_t, 6> kNanoseconds = {3'600'000'000'000, 60'000'000'000, 1'000'000'000,
                                                        1'000'000,         1'000,          1};
  constexpr std::size_t kDigits = 8;  // as gRPC's protocol has it
  if (text.size() < 2 || text.size() > kDigits + 1) return std::nullopt;
  const std::size_t unit = kUnits.find(text.back());
  std::int64_t number = 0;
  for (const char digit : text.substr(0, text.size() - 1)) {
    if (digit < '0' || digit > '9') return std::nullopt;
    number = 10 * number + (digit - '0');
  }
  constexpr std::int64_t kLongest = 24 * 3'600'000'000'000;  // longer ones are for ever
  if (unit == std::string_view::npos || number > kLongest / kNanoseconds[unit]) return std::nullopt;
  return monotonic_now() + std::chrono::nanoseconds(number * kNanoseconds[unit]);
}

template <class Request>
std::optional<Request> parsed(const std::string& message) {
  Request request;
  if (!request.ParseFromString(message)) return std::nullopt;
  return request;
}

template <class Outcome, class Fill>
Reply reply_with(const Result<Outcome>& outcome, Fill fill) {
  if (!outcome) return to_reply(to_status(outcome.error()));
  return {.body = fill(*outcome).SerializeAsString()};
}

template <class Response>
Response reports_in(const std::vector<api::DeviceStop>& stops) {
  Response response;
  for (const api::DeviceStop& one : stops) *response.add_devices() = to_proto(one);
  if (response.devices_size() != 1) return response;
  const v1::DeviceStop& only = response.devices(0);
  *response.mutable_axes() = only.axes();
  if (only.has_problem()) *response.mutable_problem() = only.problem();
  return response;
}

// Of a stop. Its answer is made by the end of max_wait.
template <class Request>
api::Call call_of_stop(const api::Credential& credential, const Headers& headers, const Request& request) {
  api::Call call = to_call(credential, deadline_of(headers), request.context());
  if (request.has_max_wait()) {
    const TimePoint end = monotonic_now() + std::max(Duration::zero(), to_duration(request.max_wait()));
    call.deadline = std::min(end, call.deadline.value_or(end));
  }
  return call;
}

v1::ListDevicesResponse list_of(const std::vector<api::DeviceState>& devices) {
  v1::ListDevicesResponse response;
  for (const api::DeviceState& one : devices) *response.add_devices() = to_proto(*one.device, *one.state);
  return response;
}

}  // namespace

Verdict Desk::judge(const Headers& headers, const Peer& peer, bool stops_only) {
  const std::string_view method = method_of(headers);
  const RequestKind kind = kind_of(method);
  const Result<server::Caller> caller = api_.admission.let_in(kind, credential_for_limits(headers, peer), method);
  if (!caller) return refused(headers, peer, caller.error());
  const std::string named = caller->who == kAnonymous ? "" : caller->who;
  if (api::rule_of(kind).quota == api::Quota::none) return {.what = Verdict::What::answer, .caller = named};
  if (stops_only) {
    metrics_.count(method, grpc::RESOURCE_EXHAUSTED);
    return refused(headers, peer, nothing_left());
  }
  if (kind == RequestKind::unlisted) {
    return {.what = Verdict::What::refuse, .refusal = no_such_method(method), .unwanted = true};
  }
  return {.what = Verdict::What::forward, .place = api_.admission.take_place(kind, caller->who), .caller = named};
}

front::Verdict Desk::refused(const Headers& headers, const Peer& peer, const Problem& problem) {
  refusals_.note(peer, credential_of(headers, peer), method_of(headers), problem.reason, problem.message);
  return {.what = Verdict::What::refuse,
          .refusal = to_reply(to_status(problem)),
          .unwanted = problem.reason != Reason::queue_full};
}

front::Reply Desk::no_room() { return to_reply(to_status(nothing_left())); }

void Desk::answer(const Headers& headers, const Peer& peer, const std::string& message,
                  std::function<void(Reply)> reply) {
  const std::string method(method_of(headers));
  auto counted = [this, method, reply = std::move(reply)](Reply given) {
    metrics_.count(method, static_cast<grpc::StatusCode>(given.code));
    reply(std::move(given));
  };
  const api::Credential credential = credential_of(headers, peer);
  switch (kind_of(method)) {
    case RequestKind::stop: {
      const auto request = parsed<v1::StopRequest>(message);
      if (!request) return counted(to_reply(to_status(not_readable(method))));
      return api_.stops.stop(call_of_stop(credential, headers, *request), request->device(), to_axes(request->axes()),
                             [counted](const Result<std::vector<api::DeviceStop>>& stops) {
                               counted(reply_with(stops, reports_in<v1::StopResponse>));
                             });
    }
    case RequestKind::emergency_stop: {
      const auto request = parsed<v1::EmergencyStopRequest>(message);
      if (!request) return counted(to_reply(to_status(not_readable(method))));
      return api_.stops.emergency_stop(call_of_stop(credential, headers, *request), request->device(),
                                       [counted](const Result<std::vector<api::DeviceStop>>& stops) {
                                         counted(reply_with(stops, reports_in<v1::EmergencyStopResponse>));
                                       });
    }
    default:
      return counted(reply_with(api_.devices.list({.credential = credential}), list_of));
  }
}

}  // namespace axisgate::rpc
