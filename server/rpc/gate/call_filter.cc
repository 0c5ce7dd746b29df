#include "server/rpc/gate/call_filter.h"

#include <fmt/format.h>
#include <grpcpp/support/status.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "device/core/escape.h"
#include "device/link/clock.h"
#include "server/access/access.h"
#include "server/rpc/calls/bearer.h"
#include "server/rpc/calls/status.h"
#include "server/rpc/gate/method_kinds.h"

namespace axisgate::rpc {
namespace {

using api::RequestKind;
using front::Decision;
using front::Headers;
using front::Peer;
using front::Reply;

// Callers without a name of their own. They share their limits, since no reliable mark distinguishes them.
constexpr const char* kAnonymous = "a caller over TCP";

// Returns the credential by which the call's limits are counted.
api::Credential credential_for_limits(const Headers& headers, const Peer& peer) {
  if (auto token = token_in(find(headers, "authorization"))) return {.token = std::move(token)};
  const bool anonymous = !peer.needs_token && server::is_anonymous(peer.who);
  return {.who = anonymous ? kAnonymous : peer.who, .needs_token = peer.needs_token};
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

// Reads `grpc-timeout`: a number and H, M, S, m, u or n.
std::optional<TimePoint> deadline_of(const Headers& headers) {
  const std::string_view text = find(headers, "grpc-timeout").value_or("");
  constexpr std::string_view kUnits = "HMSmun";
  constexpr std::array<std::int64_t, 6> kNanoseconds = {3'600'000'000'000, 60'000'000'000, 1'000'000'000,
                                                        1'000'000,         1'000,          1};
  constexpr std::size_t kDigits = 8;  // the maximum of gRPC's protocol
  if (text.size() < 2 || text.size() > kDigits + 1) return std::nullopt;
  const std::size_t unit = kUnits.find(text.back());
  std::int64_t number = 0;
  for (const char digit : text.substr(0, text.size() - 1)) {
    if (digit < '0' || digit > '9') return std::nullopt;
    number = 10 * number + (digit - '0');
  }
  constexpr std::int64_t kLongestDeadline = 24 * 3'600'000'000'000;  // a longer timeout counts as none
  if (unit == std::string_view::npos || number > kLongestDeadline / kNanoseconds[unit]) return std::nullopt;
  return monotonic_now() + std::chrono::nanoseconds(number * kNanoseconds[unit]);
}

}  // namespace

Decision CallFilter::decide(const Headers& headers, const Peer& peer, bool stops_only) {
  const std::string_view method = method_of(headers);
  const RequestKind kind = kind_of(method);
  if (kind == RequestKind::unlisted) {
    return {.what = Decision::What::refuse, .refusal = no_such_method(method), .denied = true};
  }
  const Result<server::Caller> caller = api_.admission.let_in(kind, credential_for_limits(headers, peer), method);
  if (!caller) return refused(headers, peer, caller.error());
  const std::string named = caller->who == kAnonymous ? "" : caller->who;
  const auto what = OwnAnswers::row_of(kind) != nullptr ? Decision::What::answer : Decision::What::forward;
  if (api::rule_of(kind).quota == api::Quota::none) {
    return {.what = what, .path = served_as(method), .uncounted = true, .caller = named};
  }
  // gRPC itself would answer CANCELLED.
  if (const auto ending = api_.streams.ending()) {
    metrics_.count(method, grpc::UNAVAILABLE);
    return {.what = Decision::What::refuse, .refusal = to_reply(*ending)};
  }
  if (stops_only) {
    metrics_.count(method, grpc::RESOURCE_EXHAUSTED);
    return refused(headers, peer, nothing_left());
  }
  return {
      .what = what, .place = api_.admission.take_place(kind, caller->who), .path = served_as(method), .caller = named};
}

front::Decision CallFilter::refused(const Headers& headers, const Peer& peer, const Problem& problem) {
  refusals_.note(peer, credential_of(headers, peer), method_of(headers), problem.reason, problem.message);
  return {.what = Decision::What::refuse, .refusal = to_reply(problem), .denied = problem.reason != Reason::queue_full};
}

front::Reply CallFilter::no_room() { return to_reply(nothing_left()); }

std::unique_ptr<front::Answer> CallFilter::answer(const Headers& headers, const Peer& peer,
                                                  std::optional<std::string_view> message, std::function<void()> wake) {
  return answers_.answer(*OwnAnswers::row_of(kind_of(method_of(headers))),
                         std::make_shared<Served>(metrics_, refusals_, headers, peer), deadline_of(headers), message,
                         std::move(wake));
}

}  // namespace axisgate::rpc
