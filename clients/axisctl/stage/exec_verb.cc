// exec: sends raw controller commands; prints answers and completions, and nothing else.
#include <google/protobuf/util/time_util.h>

#include <chrono>
#include <string>

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
  } else {
    print_line(std::to_string(response.completion()));
  }
}

}  // namespace

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

}  // namespace axisgate::axisctl
