// A stream of answers that begins again after a broken connection.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "clients/cpp/src/session.h"

namespace axisgate::client {

// One thread reads at a time; close() may be called from any thread.
template <class Response>
class Feed {
 public:
  using Reader = grpc::ClientReader<Response>;
  // Begins the call, from the place that is to be read next.
  using Begin = std::function<std::unique_ptr<Reader>(grpc::ClientContext&)>;
  // Takes the failure of the call, if the feed can continue after it at once.
  using Skip = std::function<bool(const Failure&)>;

  // Begins the call. The daemon has begun to watch when this returns, or resume() reports why not.
  Feed(std::shared_ptr<DeviceSession> session, Begin begin, Skip skip)
      : session_(std::move(session)), begin_(std::move(begin)), skip_(std::move(skip)) {
    start();
    reader_->WaitForInitialMetadata();  // the daemon sends the headers at once
  }
  ~Feed() {
    close();
    if (!reader_) return;
    Response ignored;
    while (reader_->Read(&ignored)) continue;
    (void)reader_->Finish();
  }
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  // Waits for the next answer. Returns false if the call has broken: resume() begins it again.
  bool read(Response& response) {
    if (!reader_ || !reader_->Read(&response)) return false;
    backoff_.reset();
    return true;
  }

  // Begins the call again, after a pause unless the failure is skipped. Throws Error if the daemon refuses to continue.
  // Returns false after close() and after an error.
  bool resume() {
    if (!reader_) return false;
    const grpc::Status status = std::exchange(reader_, nullptr)->Finish();
    if (closed()) return false;
    const Failure failure(status.ok() ? grpc::Status(grpc::UNAVAILABLE, "the stream has ended") : status);
    if (!skip_(failure)) {
      if (!failure.passing() && failure.reason() != "QUEUE_FULL") {
        throw_error(failure, session_->connection().address());
      }
      std::unique_lock lock(mutex_);
      closing_.wait_for(lock, backoff_.pause(), [this] { return closed_; });
    }
    if (closed()) return false;
    start();
    return true;
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    if (context_) context_->TryCancel();
    closing_.notify_all();
  }

 private:
  void start() {
    auto context = std::make_unique<grpc::ClientContext>();
    auto reader = begin_(*context);
    const std::lock_guard lock(mutex_);
    if (closed_) context->TryCancel();
    reader_ = std::move(reader);
    context_ = std::move(context);
  }

  bool closed() {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

  const std::shared_ptr<DeviceSession> session_;
  const Begin begin_;
  const Skip skip_;
  Backoff backoff_;
  std::mutex mutex_;
  std::condition_variable closing_;
  bool closed_ = false;
  std::unique_ptr<grpc::ClientContext> context_;
  std::unique_ptr<Reader> reader_;
};

}  // namespace axisgate::client
