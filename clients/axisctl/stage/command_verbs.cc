// exec and commands: send raw controller commands, and list them. exec prints answers and completions, nothing else.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <string>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

constexpr std::chrono::seconds kWait{20};
// Time that the call's deadline adds to kWait. The daemon itself ends the call after kWait; the deadline only catches a
// daemon that hangs.
constexpr std::chrono::seconds kGrace{2};

void show(const v1::ExecuteResponse& response, bool json) {
  if (json) {
    print_json(response);
  } else if (response.has_reply()) {
    print_line(response.reply().answer());
  } else if (response.change_case() == v1::ExecuteResponse::kCompletion) {
    print_line(std::to_string(response.completion()));
  }
}

v1::ListCommandsResponse command_table(const Session& session) {
  v1::ListCommandsRequest request;
  request.set_device(chosen_device(session).name());
  return session.connection.call(session.connection.commands, &v1::CommandService::Stub::ListCommands, request,
                                 kQuestionLimit);
}

void print_command(const v1::Command& command, bool with_parameters) {
  print_line(fmt::format("{:<8} {:<28} {}", command.name(), command.format(), command.description()));
  if (!with_parameters) return;
  for (const std::string& parameter : command.parameters()) print_line("         " + parameter);
  print_line(fmt::format("         manual {}{}", command.section(), command.moves() ? "; may start motion" : ""));
}

int execute(const Session& session) {
  v1::ExecuteRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(chosen_device(session).name());
  for (const std::string& line : session.options.lines) request.add_lines(line);
  *request.mutable_timeout() = google::protobuf::util::TimeUtil::SecondsToDuration(kWait.count());
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kWait + kGrace);
  const auto reader = session.connection.commands->Execute(&context, request);
  v1::ExecuteResponse response;
  while (reader->Read(&response)) show(response, session.options.json);
  session.connection.check(reader->Finish());
  return kDone;
}

int commands(const Session& session) {
  const std::string& wanted = session.options.command;
  bool found = false;
  const v1::ListCommandsResponse table = command_table(session);
  for (const v1::Command& command : table.commands()) {
    if (!wanted.empty() && command.name() != wanted) continue;
    found = true;
    if (session.options.json) {
      print_json(command);
    } else {
      print_command(command, !wanted.empty());
    }
  }
  if (found || wanted.empty()) return kDone;
  throw Failure{kUsage, "UNKNOWN_COMMAND", fmt::format("the command table has no command \"{}\"", wanted),
                "axisctl commands lists them"};
}

void exec_options(CLI::App& verb, Options& options) {
  verb.add_option("LINE", options.lines, "raw controller command, e.g. '?:P1'; `axisctl commands` lists them")
      ->required()
      ->type_name("");
}

void commands_options(CLI::App& verb, Options& options) {
  verb.add_option("COMMAND", options.command, "show one command with its parameters, e.g. M:")->type_name("");
}

constexpr Verb kCommandVerbs[] = {
    {.words = "exec",
     .heading = Heading::raw,
     .description = "send raw controller commands; no motion of other callers comes between",
     .help = "Each LINE is a command of the manual. `axisctl commands` lists them.",
     .examples = "axisctl exec 'M:1+P1000' 'G:1'",
     .add_options = exec_options,
     .run = execute},
    {.words = "commands",
     .heading = Heading::raw,
     .description = "list the raw commands of the controller",
     .examples = "axisctl commands M:",
     .add_options = commands_options,
     .run = commands},
};

}  // namespace

std::span<const Verb> command_verbs() { return kCommandVerbs; }

}  // namespace axisgate::axisctl
