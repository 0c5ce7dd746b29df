// A stream that asks for the next message after the last one was sent, so that no queue forms for a slow reader.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <mutex>
#include <utility>
#include <variant>

namespace axisgate::rpc {

// `Reactor` is grpc::ServerWriteReactor<Response> or a ServerBidiReactor of Response. Shared pointers own the stream,
// since a wake-up, a timer or a device's answer may come after OnDone. At most one StartWrite is outstanding, and
// Finish waits for it.
template <class Reactor, class Response>
class PullStream : public Reactor, public std::enable_shared_from_this<PullStream<Reactor, Response>> {
 public:
  // Thread safe. Call it whenever next() may have something new.
  void pump() {
    std::unique_lock lock(mutex_);
    if (finished_ || writing_) return;
    Next upcoming = cancelled_ ? Next(grpc::Status::CANCELLED) : next();
    // The lock is released before the call of gRPC, which may call back at once.
    if (auto* message = std::get_if<Response>(&upcoming)) {
      outgoing_ = std::move(*message);
      writing_ = true;
      lock.unlock();
      this->StartWrite(&outgoing_);
    } else if (auto* status = std::get_if<grpc::Status>(&upcoming)) {
      finished_ = true;
      lock.unlock();
      this->Finish(std::move(*status));
    }
  }

  void OnWriteDone(bool ok) override {
    {
      const std::lock_guard lock(mutex_);
      writing_ = false;
      cancelled_ = cancelled_ || !ok;
    }
    pump();
  }

  void OnCancel() override {
    {
      const std::lock_guard lock(mutex_);
      cancelled_ = true;
    }
    pump();
  }

  void OnDone() override {
    closed();
    self_.reset();
  }

 protected:
  struct Wait {};
  using Next = std::variant<Wait, Response, grpc::Status>;

  // Returns the next message, the final status, or Wait if there is nothing before the next pump(). Called under
  // mutex_, by one thread at a time, never after the final status.
  virtual Next next() = 0;

  // Called when the call is over. Overrides unsubscribe from the source that wakes this stream.
  virtual void closed() {}

  // Sends the headers at once, so that the caller knows that the stream is open. Call it after construction.
  void open() {
    self_ = this->shared_from_this();
    this->StartSendInitialMetadata();
  }

  bool cancelled() {
    const std::lock_guard lock(mutex_);
    return cancelled_;
  }

  // Returns a shared pointer to the whole object.
  template <class Derived>
  std::shared_ptr<Derived> self() {
    return std::static_pointer_cast<Derived>(this->shared_from_this());
  }

  std::mutex mutex_;  // also protects the derived class's state

 private:
  bool writing_ = false;
  bool cancelled_ = false;
  bool finished_ = false;
  Response outgoing_;
  std::shared_ptr<PullStream> self_;
};

}  // namespace axisgate::rpc
