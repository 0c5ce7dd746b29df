// lease run, list, hand-over, and rearm: the right to move axes.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/gateway/child.h"
#include "clients/axisctl/held_lease.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

// `covering`: a Lease, a WaitingLease, a Latch or a RearmResponse.
template <class Message>
std::string scope_text(const Message& covering) {
  if (covering.whole_device()) return "the whole device";
  return fmt::format("{} {}", covering.axes_size() == 1 ? "axis" : "axes", fmt::join(covering.axes(), ", "));
}

std::string latch_text(const v1::Latch& latch) {
  return fmt::format("stopped by {} at {} on {}: must rearm", latch.by(), time_text(latch.time()), scope_text(latch));
}

void print_board(const v1::WatchLeasesResponse& board) {
  for (const v1::Lease& lease : board.leases()) {
    std::string text =
        fmt::format("{}  held by {} since {}", scope_text(lease), lease.holder(), time_text(lease.since_time()));
    if (!lease.purpose().empty()) text += fmt::format("  ({})", lease.purpose());
    if (!lease.ending().empty()) text += fmt::format("  ending: {}", lease.ending());
    if (lease.has_latch()) text += "  " + latch_text(lease.latch());
    print_line(text);
  }
  for (const v1::WaitingLease& waiting : board.waiting()) {
    std::string text = fmt::format("{}  {} waits since {}  place {} in the queue", scope_text(waiting),
                                   waiting.holder(), time_text(waiting.since_time()), waiting.place());
    if (!waiting.purpose().empty()) text += fmt::format("  ({})", waiting.purpose());
    if (waiting.has_expected_wait()) text += fmt::format("  expected wait {} s", waiting.expected_wait().seconds());
    print_line(text);
  }
  for (const v1::HeldBack& held_back : board.held_back()) {
    print_line(fmt::format("{}  {}", held_back.who(), latch_text(held_back.latch())));
  }
  if (board.leases().empty() && board.waiting().empty() && board.held_back().empty()) print_line("no leases");
}

v1::WatchLeasesResponse board_now(const Session& session, const std::string& device) {
  v1::WatchLeasesRequest request;
  request.set_device(device);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kQuestionLimit);
  const auto stream = session.connection.control->WatchLeases(&context, request);
  v1::WatchLeasesResponse board;
  const bool read = stream->Read(&board);
  context.TryCancel();
  v1::WatchLeasesResponse later;
  while (stream->Read(&later)) continue;
  const grpc::Status status = stream->Finish();
  if (!read) session.connection.check(status);
  return board;
}

void print_released(const v1::RearmResponse& response) {
  for (const v1::Latch& latch : response.latches()) {
    print_line(
        fmt::format("released: the stop of {} by {} at {}", scope_text(latch), latch.by(), time_text(latch.time())));
  }
  print_line(fmt::format("{} may move again", scope_text(response)));
}

// Explains that nothing was rearmed. A lease of another caller may have a latch, which this call could not end.
std::string nothing_rearmed(const v1::WatchLeasesResponse& board) {
  for (const v1::Lease& lease : board.leases()) {
    if (!lease.has_latch()) continue;
    return fmt::format(
        "you have no latch; a lease of {} has one on {}: to end it, run `axisctl rearm` as its holder, or inside its "
        "`axisctl lease run`",
        lease.holder(), scope_text(lease.latch()));
  }
  for (const v1::HeldBack& one : board.held_back()) {
    return fmt::format("you have no latch; {} has one on {}, and must rearm", one.who(), scope_text(one.latch()));
  }
  return "there is no latch";
}

}  // namespace

int with_lease(const Session& session, int (*verb)(const Session&)) {
  if (!session.options.wait_s) return verb(session);
  std::vector<std::string> axes = session.options.axes;
  for (const std::string& place : session.options.places) axes.push_back(place.substr(0, place.find('=')));
  const HeldLease held(session, any_device(session), axes);
  ::setenv(kLeaseVariable, lease_text(held.lease().token()).c_str(), 1);
  return verb(session);
}

int lease_run(const Session& session) {
  const HeldLease held(session, any_device(session), session.options.axes);
  return run_child(session.options.lines, kLeaseVariable, lease_text(held.lease().token()));
}

int lease_list(const Session& session) {
  v1::WatchLeasesRequest request;
  request.set_device(any_device(session).name());
  if (!session.options.follow) {
    const v1::WatchLeasesResponse board = board_now(session, request.device());
    session.options.json ? print_json(board) : print_board(board);
    return kDone;
  }
  grpc::ClientContext context;
  const auto stream = session.connection.control->WatchLeases(&context, request);
  v1::WatchLeasesResponse board;
  bool any = false;
  while (stream->Read(&board)) {
    if (any && !session.options.json) print_line("");
    any = true;
    session.options.json ? print_json(board) : print_board(board);
  }
  session.connection.check(stream->Finish());
  return kDone;
}

int lease_hand_over(const Session& session) {
  v1::HandOverLeaseRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  if (request.context().lease_token().empty())
    throw usage("this is not inside `axisctl lease run`", "only the holder can hand a lease over");
  request.set_device(any_device(session).name());
  request.set_to(session.options.holder);
  session.connection.call(session.connection.control, &v1::ControlService::Stub::HandOverLease, request,
                          kQuestionLimit);
  print_line(fmt::format("handed over to {}", session.options.holder));
  return kDone;
}

int rearm(const Session& session) {
  v1::RearmRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  const v1::Device device = any_device(session);
  request.set_device(device.name());
  const v1::RearmResponse response =
      session.connection.call(session.connection.control, &v1::ControlService::Stub::Rearm, request, kQuestionLimit);
  if (session.options.json) {
    print_json(response);
    return kDone;
  }
  if (response.latches().empty()) {
    print_line(nothing_rearmed(board_now(session, request.device())));
  } else {
    print_released(response);
  }
  if (device.has_emergency_latch()) {
    print_line(fmt::format("the emergency stop of {} remains, and nothing moves: `axisctl clear` ends it",
                           device.emergency_latch().who()));
  }
  return kDone;
}

}  // namespace axisgate::axisctl
