#include "clients/axisctl/upload_steps.h"

#include <algorithm>

namespace axisgate::axisctl {
namespace {

constexpr std::chrono::seconds kStepLimit{10};
constexpr std::size_t kSlowestBytes = 1000;  // bytes per second
// Maximum number of bytes that are still to be sent when gRPC reports a message as written: gRPC's buffer and one
// window of HTTP/2.
constexpr std::size_t kOnTheirWay = 2 * 65'536;

}  // namespace

std::chrono::seconds upload_limit(std::size_t bytes) {
  return kStepLimit + std::chrono::seconds(bytes / kSlowestBytes);
}

std::chrono::seconds UploadSteps::answer_limit(std::size_t bytes) { return upload_limit(std::min(bytes, kOnTheirWay)); }

bool UploadSteps::ended_within(std::chrono::seconds limit) {
  void* tag = nullptr;
  bool ok = false;
  const auto deadline = std::chrono::system_clock::now() + limit;
  if (queue_.AsyncNext(&tag, &ok, deadline) == grpc::CompletionQueue::TIMEOUT) {
    stalled_ = true;
    context_.TryCancel();
    queue_.Next(&tag, &ok);
  }
  return ok;
}

}  // namespace axisgate::axisctl
