// A stream of messages that asks for the next one when the last has gone out, so that nothing queues up per reader.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <mutex>
#include <utility>
#include <variant>

namespace axisgate::rpc {

// `Reactor` is grpc::ServerWriteReactor<Response> or a ServerBidiReactor with it. Held by shared pointers: a wake-up, a
// timer or a device's answer may come after OnDone. At most one StartWrite is outstanding, and Finish waits for it.
template <class Reactor, class Response>
class PullStream : public Reactor, public std::enable_shared_from_this<PullStream<Reactor, Response>> {
 public:
  // From any thread, whenever next() may have something new.
  void pump() {
    std::unique_lock lock(mutex_);
    if (finished_ || writing_) return;
    Next upcoming = cancelled_ ? Next(grpc::Status::CANCELLED) : next();
    // gRPC is called without the lock, since it may call back at once.
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

  // What goes out next: a message, the end, or nothing before the next pump(). Called under mutex_, by one thread at a
  // time, never after the end.
  virtual Next next() = 0;

  // The call is over: leave whatever wakes this stream.
  virtual void closed() {}

  // Sends the headers at once, so that a caller knows that its stream stands. Call it when construction has ended.
  void open() {
    self_ = this->shared_from_this();
    this->StartSendInitialMetadata();
  }

  bool cancelled() {
    const std::lock_guard lock(mutex_);
    return cancelled_;
  }

  // A shared pointer to the whole object.
  template <class Derived>
  std::shared_ptr<Derived> self() {
    return std::static_pointer_cast<Derived>(this->shared_from_this());
  }

  std::mutex mutex_;  // of the derived class's state, too

 private:
  bool writing_ = false;
  bool cancelled_ = false;
  bool finished_ = false;
  Response outgoing_;
  std::shared_ptr<PullStream> self_;
};

}  // namespace axisgate::rpc
