#include "clients/cpp/src/execute.h"

#include <google/protobuf/util/time_util.h>

#include <utility>

#include "clients/cpp/src/identity.h"

namespace axisgate::client {
namespace {

using google::protobuf::util::TimeUtil;

// Longest time for the replies and completions, and for the daemon's answer after that.
constexpr milliseconds kExecuteTime{20'000}, kExecuteAnswer{5000};

// Throws the error of lines that failed. It is not Refused, which means that nothing moved, if lines were sent that may
// move.
[[noreturn]] void throw_executed(const Failure& failure, bool moves, const std::string& target) {
  try {
    throw_error(failure, target);
  } catch (const Refused& error) {
    if (!moves || !failure.problem) throw;
    ErrorParts parts = to_parts(*failure.problem, error.code());
    const bool uncertain = dynamic_cast<const Unavailable*>(&error) != nullptr || error.reason() == "DEADLINE_PASSED";
    if (uncertain) throw OutcomeUnknown(std::move(parts));
    throw MotionFailed(std::move(parts));
  }
}

}  // namespace

Executed execute(DeviceSession& session, const std::vector<std::string>& lines) {
  v1::ExecuteRequest request;
  request.mutable_context()->set_request_id(new_uuid());
  request.mutable_context()->set_lease_token(session.token());
  request.set_device(session.device());
  for (const std::string& line : lines) request.add_lines(line);
  *request.mutable_timeout() = TimeUtil::MillisecondsToDuration(kExecuteTime.count());
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kExecuteTime + kExecuteAnswer);
  const auto call = session.services().commands.Execute(&context, request);
  Executed executed;
  v1::Motion started;
  v1::ExecuteResponse response;
  while (call->Read(&response)) {
    if (response.has_motion()) started.set_name(response.motion());
    if (response.has_reply()) executed.replies.push_back(response.reply().answer());
  }
  const grpc::Status status = call->Finish();
  const bool moves = !started.name().empty();
  if (!status.ok()) throw_executed(Failure(status), moves, session.connection().address());
  started.set_request_id(request.context().request_id());
  if (moves) executed.motion = session.to_motion(std::move(started));
  return executed;
}

}  // namespace axisgate::client
