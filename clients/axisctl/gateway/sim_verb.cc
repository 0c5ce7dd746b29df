// sim: simulates the actions of a person at a simulated device.
#include <CLI/CLI.hpp>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

int simulate(const Session& session) {
  v1::OperateRequest request;
  request.set_device(any_device(session).name());
  for (const std::string& word : session.options.lines) {
    *request.mutable_command() += (request.command().empty() ? "" : " ") + word;
  }
  const v1::OperateResponse done = session.connection.call(
      session.connection.simulators, &v1::SimulatorService::Stub::Operate, request, kQuestionLimit);
  if (session.options.json) {
    print_json(done);
  } else {
    print_line(done.answer().empty() ? "OK" : done.answer());
  }
  return kDone;
}

void sim_options(CLI::App& verb, Options& options) {
  verb.add_option("COMMAND", options.lines, "`help` lists them")->required()->type_name("");
}

constexpr Verb kSimVerbs[] = {
    {.words = "sim",
     .heading = Heading::raw,
     .description = "simulator only: press buttons, switch inputs, trip limits, unplug",
     .help = "For a simulated device: what a person can do at the controller. `axisctl sim help` lists the commands.",
     .examples = "axisctl sim help\naxisctl sim inputs 5\naxisctl sim limit 1 cw off\naxisctl sim position",
     .add_options = sim_options,
     .run = simulate},
};

}  // namespace

std::span<const Verb> sim_verbs() { return kSimVerbs; }

}  // namespace axisgate::axisctl
