// withdraw and clear: for administrators, after stops and errors.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "clients/axisctl/arguments/verb_options.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

int withdraw_stop(const Session& session) {
  v1::WithdrawStopRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_stop(fmt::format("{}/stops/{}", chosen_device(session).name(), session.options.open_stop));
  const v1::WithdrawStopResponse response = session.connection.call(
      session.connection.devices, &v1::DeviceService::Stub::WithdrawStop, request, kQuestionLimit);
  if (session.options.json) {
    print_json(response);
  } else {
    print_line(fmt::format("stop {} was withdrawn; nobody has seen its axes obey it", session.options.open_stop));
  }
  return kDone;
}

int clear(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::ClearErrorsRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  for (const int axis : find_axes(device, session.options.axes)) request.add_axes(std::to_string(axis));
  const v1::ClearErrorsResponse response = session.connection.call(
      session.connection.devices, &v1::DeviceService::Stub::ClearErrors, request, kQuestionLimit);
  if (session.options.json) {
    print_json(response);
    return kDone;
  }
  print_line("cleared; after an emergency stop the motors may be off: axisctl status");
  if (chosen_device(session).has_emergency_latch()) {
    print_line("the emergency stop remains, and nothing moves: `axisctl clear` without axes ends it");
  }
  return kDone;
}

void withdraw_options(CLI::App& verb, Options& options) {
  verb.add_option("STOP", options.open_stop, "its number, as `axisctl status` shows it")->required()->type_name("");
}

constexpr Verb kClearVerbs[] = {
    {.words = "withdraw",
     .heading = Heading::stopping,
     .description = "for administrators: abandon an open stop, whose controller will never answer again",
     .help =
         R"(An open stop refuses motion of its axes until the gateway has seen them stationary. If its controller will never answer
again, an administrator can abandon the stop. The history records who did it.)",
     .examples = "axisctl withdraw 12",
     .add_options = withdraw_options,
     .run = withdraw_stop},
    {.words = "clear",
     .heading = Heading::stopping,
     .description = "for administrators: clear limit, overflow and emergency-stop errors",
     .help =
         R"(Needs the role admin, unless `admin_commands` in the configuration leaves out BEC:. After an emergency stop the motors
may be off. Only `clear` without axes ends an emergency stop, once that stop is confirmed. `rearm` ends the latch of a
stop by somebody else.)",
     .examples = "axisctl clear\naxisctl motor 1,2,3 on",
     .add_options = add_axes,
     .run = clear},
};

}  // namespace

std::span<const Verb> clear_verbs() { return kClearVerbs; }

}  // namespace axisgate::axisctl
