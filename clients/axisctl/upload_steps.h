// Upload of a request in several messages, each with a separate time limit, so that a slow upload continues and only a
// stalled upload is abandoned.
#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <cstddef>
#include <vector>

namespace axisgate::axisctl {

// Maximum size of a message in bytes, small enough to distinguish a slow upload from a stalled upload.
inline constexpr std::size_t kUploadPiece = 1 << 14;

// Returns the time limit for sending a message of `bytes`, or for a whole upload, with all attempts.
std::chrono::seconds upload_limit(std::size_t bytes);

class UploadSteps {
 public:
  // `context` is the context of the call, and must outlive this object. The call must use queue().
  explicit UploadSteps(grpc::ClientContext& context) : context_(context) {}

  grpc::CompletionQueue* queue() { return &queue_; }

  // Sends the messages and waits for the answer. Returns DEADLINE_EXCEEDED if a step took too long. Call it only once.
  template <class Request>
  grpc::Status run(grpc::ClientAsyncWriter<Request>& writer, const std::vector<Request>& messages) {
    std::size_t bytes = 0;
    writer.StartCall(this);
    bool continues = ended_within(upload_limit(0));
    for (std::size_t i = 0; i < messages.size() && continues; ++i) {
      const std::size_t size = messages[i].ByteSizeLong();
      bytes += size;
      writer.Write(messages[i], this);
      continues = ended_within(upload_limit(size));  // false: the daemon has refused; the status has the reason
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
  // Waits for the current operation. Returns false if it failed. Cancels the call after the limit.
  bool ended_within(std::chrono::seconds limit);
  static std::chrono::seconds answer_limit(std::size_t bytes);

  grpc::ClientContext& context_;
  grpc::CompletionQueue queue_;
  bool stalled_ = false;
};

}  // namespace axisgate::axisctl
