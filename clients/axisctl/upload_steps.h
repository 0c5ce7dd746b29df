// A request in several messages, each with a time limit of its own: over a slow connection an upload takes long, and
// only one that stalls is abandoned.
#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <cstddef>
#include <vector>

namespace axisgate::axisctl {

// No message is longer than this, so that a slow upload differs from one that stalls.
inline constexpr std::size_t kUploadPiece = 1 << 14;

// A message of `bytes` is on its way no longer than this; so is a whole upload, with all attempts.
std::chrono::seconds upload_limit(std::size_t bytes);

class UploadSteps {
 public:
  // `context` is that of the call, which is made over queue(); it outlives this.
  explicit UploadSteps(grpc::ClientContext& context) : context_(context) {}

  grpc::CompletionQueue* queue() { return &queue_; }

  // DEADLINE_EXCEEDED where a step took too long. Once only.
  template <class Request>
  grpc::Status run(grpc::ClientAsyncWriter<Request>& writer, const std::vector<Request>& messages) {
    std::size_t bytes = 0;
    writer.StartCall(this);
    bool continues = ended_within(upload_limit(0));
    for (std::size_t i = 0; i < messages.size() && continues; ++i) {
      const std::size_t size = messages[i].ByteSizeLong();
      bytes += size;
      writer.Write(messages[i], this);
      continues = ended_within(upload_limit(size));  // false: the daemon has refused, and why is in the status
    }
    if (continues) {
      writer.WritesDone(this);
      ended_within(answer_limit(bytes));
    }
    grpc::Status status;
    writer.Finish(&status, this);
    ended_within(answer_limit(bytes));
    return stalled_ ? grpc::Status(grpc::StatusCode::DEADLINE_EXCEEDED, "the upload did not move") : status;
  }

 private:
  // Waits for the operation that was begun. False where it failed; beyond its limit the call is cancelled.
  bool ended_within(std::chrono::seconds limit);
  static std::chrono::seconds answer_limit(std::size_t bytes);

  grpc::ClientContext& context_;
  grpc::CompletionQueue queue_;
  bool stalled_ = false;
};

}  // namespace axisgate::axisctl
