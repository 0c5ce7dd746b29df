// lease run, list, hand-over: the right to move axes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>
#include <vector>

#include "clients/axisctl/arguments/verb_options.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/gateway/child.h"
#include "clients/axisctl/gateway/lease_board.h"
#include "clients/axisctl/held_lease.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "clients/cpp/src/token.h"

namespace axisgate::axisctl {

int with_lease(const Session& session, int (*verb)(const Session&)) {
  if (!session.options.wait_s) return verb(session);
  std::vector<std::string> axes = session.options.axes;
  for (const std::string& place : session.options.places) axes.push_back(place.substr(0, place.find('=')));
  // The command ends like one without --wait: after Ctrl-C its motion runs to its end.
  const HeldLease held(session, any_device(session), axes, v1::AT_LOSS_FINISH);
  ::setenv(client::kLeaseVariable, client::token_text(held.lease().token()).c_str(), 1);
  return verb(session);
}

namespace {

void print_board(const v1::WatchLeasesResponse& board) {
  for (const v1::Lease& lease : board.leases()) {
    std::string text =
        fmt::format("{}  held by {} since {}", scope_text(lease), lease.holder().name(), time_text(lease.since_time()));
    if (!lease.purpose().empty()) text += fmt::format("  ({})", lease.purpose());
    if (!lease.ending().empty()) text += fmt::format("  ending: {}", lease.ending());
    if (lease.has_latch()) text += "  " + latch_text(lease.latch());
    print_line(text);
  }
  for (const v1::WaitingLease& waiting : board.waiting()) {
    std::string text = fmt::format("{}  {} waits since {}  place {} in the queue", scope_text(waiting),
                                   waiting.caller().name(), time_text(waiting.since_time()), waiting.place());
    if (!waiting.purpose().empty()) text += fmt::format("  ({})", waiting.purpose());
    if (waiting.has_expected_wait()) text += fmt::format("  expected wait {} s", waiting.expected_wait().seconds());
    print_line(text);
  }
  for (const v1::HeldBack& held_back : board.held_back()) {
    print_line(fmt::format("{}  {}", held_back.caller().name(), latch_text(held_back.latch())));
  }
  if (board.leases().empty() && board.waiting().empty() && board.held_back().empty()) print_line("no leases");
}

v1::AtLoss at_loss_named(const std::string& word) {
  if (word == "finish") return v1::AT_LOSS_FINISH;
  return word == "stop" ? v1::AT_LOSS_STOP : v1::AT_LOSS_STOP_AND_RELEASE;
}

int lease_run(const Session& session) {
  const HeldLease held(session, any_device(session), session.options.axes, at_loss_named(session.options.at_loss));
  return run_child(session.options.lines, client::kLeaseVariable, client::token_text(held.lease().token()));
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
  request.set_caller(session.options.holder);
  session.connection.call(session.connection.control, &v1::ControlService::Stub::HandOverLease, request,
                          kQuestionLimit);
  print_line(fmt::format("handed over to {}", session.options.holder));
  return kDone;
}

void lease_run_options(CLI::App& verb, Options& options) {
  verb.add_option("--axes", options.axes, "numbers or names (default: all axes)")->delimiter(',')->type_name("AXES");
  add_wait(verb, options);
  verb.add_flag("--take-over", options.take_over,
                "for administrators: stop the axes and end all other leases over them")
      ->excludes("--wait");
  verb.add_option("--at-loss", options.at_loss,
                  "what happens to a running motion when axisctl is killed or loses its connection")
      ->check(CLI::IsMember({"finish", "stop", "stop-and-release"}))
      ->capture_default_str();
  verb.add_option("--purpose", options.purpose, "why you hold the axes; others can read it")->type_name("TEXT");
  verb.add_option("COMMAND", options.lines, "the command, after --")->required()->type_name("");
  verb.positionals_at_end();
}

void lease_list_options(CLI::App& verb, Options& options) {
  verb.add_flag("--follow", options.follow, "show every change, until Ctrl-C");
}

void lease_hand_over_options(CLI::App& verb, Options& options) {
  verb.add_option("HOLDER", options.holder, "who waits, as `lease list` shows it, e.g. 'unix bert'")
      ->required()
      ->type_name("");
}

constexpr Verb kLeaseVerbs[] = {
    {.words = "lease",
     .heading = Heading::stopping,
     .description = "exclusive use of axes: run, list, hand-over",
     .help = "`axisctl help leases` explains them.",
     .examples = R"(axisctl lease run --axes 1 --wait 60 --purpose 'scan of sample 12' -- axisctl move 1=0mm
axisctl lease list)"},
    {.words = "lease run",
     .description = "hold axes while a command runs, e.g. a shell or a script",
     .add_options = lease_run_options,
     .run = lease_run},
    {.words = "lease list",
     .description = "show who holds axes, who waits for them, and who must rearm",
     .add_options = lease_list_options,
     .run = lease_list},
    {.words = "lease hand-over",
     .description = "give your axes to somebody who waits; type it in the shell that `lease run` opened",
     .add_options = lease_hand_over_options,
     .run = lease_hand_over},
};

}  // namespace

std::span<const Verb> lease_verbs() { return kLeaseVerbs; }

}  // namespace axisgate::axisctl
