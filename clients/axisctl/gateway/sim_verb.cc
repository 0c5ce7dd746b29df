// sim: simulates the actions of a person at a simulated device.
#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {

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

}  // namespace axisgate::axisctl
