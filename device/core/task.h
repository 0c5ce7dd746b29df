// Coroutines for transactions of many exchanges, so that they read from top to bottom. Sans-I/O like all of core: only
// Executor::run() resumes a suspended task, on the strand of the machine that owns the executor.
//
// Keep awaited arguments in named variables: g++ 12 mishandles some temporaries in a co_await expression.
#pragma once

#include <coroutine>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "device/core/time.h"

namespace axisgate {

template <class T>
class Task;

namespace detail {

// Record in which a spawned task notes its end, so that the executor finds ended tasks without searching all tasks.
struct Spawned {
  std::uint64_t number = 0;
  std::vector<std::uint64_t>* ended = nullptr;
};

struct FinalAwaiter {
  bool await_ready() const noexcept { return false; }
  template <class Promise>
  std::coroutine_handle<> await_suspend(std::coroutine_handle<Promise> handle) const noexcept {
    auto& promise = handle.promise();
    if (promise.spawned.ended != nullptr) promise.spawned.ended->push_back(promise.spawned.number);
    return promise.parent ? promise.parent : std::noop_coroutine();
  }
  void await_resume() const noexcept {}
};

struct PromiseBase {
  std::coroutine_handle<> parent;
  Spawned spawned;
  std::suspend_always initial_suspend() const noexcept { return {}; }
  FinalAwaiter final_suspend() const noexcept { return {}; }
  [[noreturn]] void unhandled_exception() { std::terminate(); }  // no function below throws
};

template <class T>
struct Promise : PromiseBase {
  std::optional<T> value;
  Task<T> get_return_object();
  void return_value(T result) { value.emplace(std::move(result)); }
  T take() { return std::move(*value); }
};

template <>
struct Promise<void> : PromiseBase {
  Task<void> get_return_object();
  void return_void() {}
  void take() {}
};

}  // namespace detail

// A Task starts when it is awaited or spawned, and owns its frame.
template <class T = void>
class [[nodiscard]] Task {
 public:
  using promise_type = detail::Promise<T>;
  using Handle = std::coroutine_handle<promise_type>;

  explicit Task(Handle handle) : handle_(handle) {}
  Task(Task&& other) noexcept : handle_(std::exchange(other.handle_, {})) {}
  Task& operator=(Task&&) = delete;
  ~Task() {
    if (handle_) handle_.destroy();
  }

  bool await_ready() const noexcept { return false; }
  std::coroutine_handle<> await_suspend(std::coroutine_handle<> parent) noexcept {
    handle_.promise().parent = parent;
    return handle_;
  }
  T await_resume() { return handle_.promise().take(); }

  Handle handle() const { return handle_; }

 private:
  Handle handle_;
};

template <class T>
Task<T> detail::Promise<T>::get_return_object() {
  return Task<T>(std::coroutine_handle<Promise<T>>::from_promise(*this));
}
inline Task<void> detail::Promise<void>::get_return_object() {
  return Task<void>(std::coroutine_handle<Promise<void>>::from_promise(*this));
}

// An Executor owns the spawned tasks, the tasks that are ready to continue, and the deadlines that tasks wait for.
// Destroying it destroys suspended tasks; the objects that they refer to must outlive it.
class Executor {
 public:
  void spawn(Task<void> task);
  void post(std::coroutine_handle<> handle) { ready_.push_back(handle); }
  void run();  // until no task is ready
  void advance(TimePoint now);
  std::optional<TimePoint> next_deadline() const;

  // Interface of an object that waits for a deadline; at() calls timed_out() unless the waiter has expired by then.
  struct Waiter {
    virtual ~Waiter() = default;
    virtual void timed_out() = 0;
  };
  void at(TimePoint deadline, std::weak_ptr<Waiter> waiter) { deadlines_.emplace(deadline, std::move(waiter)); }

  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

 private:
  std::map<std::uint64_t, Task<void>> tasks_;  // tasks by number, in the order in which they were spawned
  std::uint64_t next_number_ = 0;
  std::vector<std::uint64_t> ended_;
  std::vector<std::coroutine_handle<>> ready_;
  bool running_ = false;
  std::multimap<TimePoint, std::weak_ptr<Waiter>> deadlines_;
};

// Value that one task waits for and another party delivers once. Copies share the value.
template <class T>
class OneShot {
 public:
  explicit OneShot(Executor& executor) : state_(std::make_shared<State>()) { state_->executor = &executor; }

  bool delivered() const { return state_->value.has_value(); }
  void deliver(T value) {
    if (state_->value) return;
    state_->value.emplace(std::move(value));
    if (state_->waiter) state_->executor->post(std::exchange(state_->waiter, {}));
  }

  bool await_ready() const { return delivered(); }
  void await_suspend(std::coroutine_handle<> waiter) { state_->waiter = waiter; }
  T await_resume() { return std::move(*state_->value); }

 private:
  struct State {
    Executor* executor = nullptr;
    std::optional<T> value;
    std::coroutine_handle<> waiter;
  };
  std::shared_ptr<State> state_;
};

// Event that may happen repeatedly, and that tasks wait for with a time limit.
class Signal {
 public:
  explicit Signal(Executor& executor) : executor_(executor) {}
  void notify();  // wakes all tasks that wait now

  // co_await yields true when notified, false when the deadline passed first.
  OneShot<bool> wait_until(TimePoint deadline);

 private:
  struct Entry;
  Executor& executor_;
  std::vector<std::shared_ptr<Entry>> waiting_;
};

}  // namespace axisgate
