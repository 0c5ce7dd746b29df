#include "tests/bench/minimal_watchers.h"

#include <chrono>

namespace axisgate::bench {
namespace {

// Returns an event of the same size as the daemon's: a step of a path.
v1::WatchResponse event_now(std::uint64_t revision) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(now);
  v1::WatchResponse response;
  v1::Event& event = *response.mutable_event();
  event.set_revision(revision);
  event.mutable_time()->set_seconds(seconds.count());
  event.mutable_time()->set_nanos(static_cast<int>(std::chrono::nanoseconds(now - seconds).count()));
  event.set_device("devices/stage");
  event.set_run("0123456789abcdef");
  event.mutable_path_progress()->set_motion("devices/stage/motions/1");
  event.mutable_path_progress()->set_step(v1::PathProgress::STEP_SENT);
  event.mutable_path_progress()->set_segment(1);
  event.mutable_path_progress()->set_wire_reply("OK_D");
  return response;
}

}  // namespace

class MinimalWatchers::Watcher final : public grpc::ServerWriteReactor<v1::WatchResponse> {
 public:
  explicit Watcher(MinimalWatchers& all) : all_(all) {
    StartSendInitialMetadata();
    all_.add(this);
  }

  void offer(Event event) {
    const std::lock_guard lock(mutex_);
    due_.push_back(std::move(event));
    if (due_.size() == 1) step();
  }
  void OnWriteDone(bool) override {
    const std::lock_guard lock(mutex_);
    due_.pop_front();
    step();
  }
  void OnCancel() override {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
    if (due_.empty()) step();
  }
  void OnDone() override {
    all_.remove(this);
    delete this;
  }

 private:
  // Starts the next write, or finishes a cancelled stream. No write may be in flight.
  void step() {
    if (!due_.empty() && !cancelled_) return StartWrite(due_.front().get());
    if (!cancelled_ || finished_) return;
    finished_ = true;
    Finish(grpc::Status::CANCELLED);
  }

  MinimalWatchers& all_;
  std::mutex mutex_;
  std::deque<Event> due_;  // the first event is in flight
  bool cancelled_ = false, finished_ = false;
};

MinimalWatchers::MinimalWatchers(double events_per_second)
    : thread_([this, events_per_second] { publish_until_end(events_per_second); }) {}

MinimalWatchers::~MinimalWatchers() {
  ending_ = true;
  thread_.join();
}

grpc::ServerWriteReactor<v1::WatchResponse>* MinimalWatchers::Watch(grpc::CallbackServerContext*,
                                                                    const v1::WatchRequest*) {
  return new Watcher(*this);
}

void MinimalWatchers::publish_until_end(double events_per_second) {
  const auto period = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::seconds(1) / events_per_second);
  auto next = std::chrono::steady_clock::now();
  for (std::uint64_t revision = 1; !ending_; ++revision) {
    std::this_thread::sleep_until(next += period);
    const auto event = std::make_shared<const v1::WatchResponse>(event_now(revision));
    const std::lock_guard lock(mutex_);
    for (Watcher* watcher : watchers_) watcher->offer(event);
  }
}

void MinimalWatchers::add(Watcher* watcher) {
  const std::lock_guard lock(mutex_);
  watchers_.insert(watcher);
}

void MinimalWatchers::remove(Watcher* watcher) {
  const std::lock_guard lock(mutex_);
  watchers_.erase(watcher);
}

}  // namespace axisgate::bench
