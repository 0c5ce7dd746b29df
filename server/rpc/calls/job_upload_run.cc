#include "server/rpc/calls/job_upload_run.h"

#include <utility>

#include "server/proto/digest.h"
#include "server/proto/mills.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/status.h"
#include "server/rpc/calls/unreadable.h"

namespace axisgate::rpc {
namespace {

constexpr const char* kSendJobMethod = "/axisgate.v1.MillService/SendJob";

}  // namespace

JobUploadRun* JobUploadRun::start(const api::JobSending& sending, const grpc::CallbackServerContext& context,
                                  const HalfClose& half_close, v1::SendJobResponse* response) {
  const std::shared_ptr<JobUploadRun> run(new JobUploadRun(sending, context, half_close, response));
  run->self_ = run;
  run->StartRead(run->incoming_.marked());
  return run.get();
}

void JobUploadRun::OnReadDone(bool ok) {
  if (!ok && incoming_.unreadable()) return end(to_status(not_readable(kSendJobMethod)));
  if (!ok) return half_close_.wait([run = shared_from_this()] { run->finish(); });
  if (const Result<void> taken = take(); !taken) return end(to_status(taken.error()));
  StartRead(incoming_.marked());
}

Result<void> JobUploadRun::take() {
  const v1::SendJobRequest& message = *incoming_;
  if (upload_ == nullptr) return begin(message);
  if (!message.has_data()) {
    return fail(Reason::invalid_request, "a message after the first has no data",
                "the header belongs in the first message, and the bytes in the others");
  }
  data_digest_.add(message.data());
  return upload_->append(message.data());
}

Result<void> JobUploadRun::begin(const v1::SendJobRequest& message) {
  if (!message.has_header()) {
    return fail(Reason::invalid_request, "the first message has no header", "send the header, then the bytes");
  }
  const v1::JobHeader& header = message.header();
  Result<api::JobToSend> job = proto::to_job(header);
  if (!job) return tl::unexpected(job.error());
  auto upload = sending_.send(to_call(context_, header.context()), header.device(), *std::move(job));
  if (!upload) return tl::unexpected(upload.error());
  upload_ = *std::move(upload);
  header_digest_ = proto::digest_of(header);
  return {};
}

void JobUploadRun::finish() {
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;  // the caller has cancelled the call
  }
  if (upload_ == nullptr) {
    return end(to_status(Problem{.reason = Reason::invalid_request, .message = "the job has no message"}));
  }
  upload_->finish(proto::job_digest(header_digest_, data_digest_.hexadecimal()),
                  [run = shared_from_this()](const Result<api::CurrentJob>& job) { run->answer(job); });
}

void JobUploadRun::answer(const Result<api::CurrentJob>& job) {
  if (!job) return end(to_status(job.error()));
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(ended_, true)) return;
  }
  *response_->mutable_job() = proto::to_proto(*job);
  Finish(grpc::Status::OK);
}

void JobUploadRun::end(const grpc::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(ended_, true)) return;
  }
  Finish(status);
}

void JobUploadRun::OnCancel() { end(grpc::Status::CANCELLED); }

}  // namespace axisgate::rpc
