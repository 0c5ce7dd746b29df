// lease run, list, hand-over, and rearm: who may move what.
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "clients/axisctl/child.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/held_lease.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

template <class Axes>
std::string axes_text(const Axes& axes) {
  return fmt::format("{} {}", axes.size() == 1 ? "axis" : "axes", fmt::join(axes, ", "));
}

std::string latch_text(const v1::Latch& latch) {
  return fmt::format("stopped by {} at {} on {}: rearm", latch.by(), time_text(latch.time()), axes_text(latch.axes()));
}

void print_board(const v1::WatchLeasesResponse& board) {
  for (const v1::Lease& lease : board.leases()) {
    std::string text =
        fmt::format("{}  held by {} since {}", axes_text(lease.axes()), lease.holder(), time_text(lease.since_time()));
    if (!lease.purpose().empty()) text += fmt::format("  ({})", lease.purpose());
    if (!lease.ending().empty()) text += fmt::format("  ending: {}", lease.ending());
    if (lease.has_latch()) text += "  " + latch_text(lease.latch());
    print_line(text);
  }
  for (const v1::WaitingLease& waiting : board.waiting()) {
    std::string text = fmt::format("{}  {}. {} waits since {}", axes_text(waiting.axes()), waiting.place(),
                                   waiting.holder(), time_text(waiting.since_time()));
    if (!waiting.purpose().empty()) text += fmt::format("  ({})", waiting.purpose());
    if (waiting.has_expected_wait()) text += fmt::format("  expected wait {} s", waiting.expected_wait().seconds());
    print_line(text);
  }
  for (const v1::HeldBack& held_back : board.held_back()) {
    print_line(fmt::format("{}  {}", held_back.who(), latch_text(held_back.latch())));
  }
  if (board.leases().empty() && board.waiting().empty() && board.held_back().empty()) print_line("no leases");
}

}  // namespace

int with_lease(const Session& session, int (*verb)(const Session&)) {
  if (!session.options.wait_s) return verb(session);
  std::vector<std::string> axes = session.options.axes;
  for (const std::string& place : session.options.places) axes.push_back(place.substr(0, place.find('=')));
  const HeldLease held(session, chosen_device(session), axes);
  ::setenv(kLeaseVariable, std::to_string(held.lease().token()).c_str(), 1);
  return verb(session);
}

int lease_run(const Session& session) {
  const HeldLease held(session, chosen_device(session), session.options.axes);
  return run_child(session.options.lines, kLeaseVariable, std::to_string(held.lease().token()));
}

int lease_list(const Session& session) {
  v1::WatchLeasesRequest request;
  request.set_device(chosen_device(session).name());
  grpc::ClientContext context;
  const auto stream = session.connection.control->WatchLeases(&context, request);
  v1::WatchLeasesResponse board;
  bool any = false;
  while (stream->Read(&board)) {
    if (any && !session.options.json) print_line("");
    any = true;
    session.options.json ? print_json(board) : print_board(board);
    if (session.options.follow) continue;
    context.TryCancel();
    while (stream->Read(&board)) continue;
    (void)stream->Finish();
    return kDone;
  }
  session.connection.check(stream->Finish());
  return kDone;
}

int lease_hand_over(const Session& session) {
  v1::HandOverLeaseRequest request;
  *request.mutable_context() = new_call_context();
  if (request.context().lease_token() == 0)
    throw usage("this is not inside `axisctl lease run`", "only the holder can hand a lease over");
  request.set_device(chosen_device(session).name());
  request.set_to(session.options.holder);
  session.connection.call(session.connection.control, &v1::ControlService::Stub::HandOverLease, request,
                          kQuestionLimit);
  print_line(fmt::format("handed over to {}", session.options.holder));
  return kDone;
}

int rearm(const Session& session) {
  v1::RearmRequest request;
  *request.mutable_context() = new_call_context();
  request.set_device(chosen_device(session).name());
  const v1::RearmResponse response =
      session.connection.call(session.connection.control, &v1::ControlService::Stub::Rearm, request, kQuestionLimit);
  if (session.options.json) {
    print_json(response);
  } else {
    print_line(response.axes().empty() ? "there was no latch" : axes_text(response.axes()) + " may move again");
  }
  return kDone;
}

}  // namespace axisgate::axisctl
