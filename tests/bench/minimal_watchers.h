// EventService.Watch of the minimal gateway: sends the same event to all streams, at a constant rate.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "axisgate/v1/event.grpc.pb.h"

namespace axisgate::bench {

// Service that publishes the events. Its code is frozen: see minimal_server.cc.
class MinimalWatchers final : public v1::EventService::CallbackService {
 public:
  explicit MinimalWatchers(double events_per_second);
  ~MinimalWatchers() override;

  grpc::ServerWriteReactor<v1::WatchResponse>* Watch(grpc::CallbackServerContext* context,
                                                     const v1::WatchRequest* request) override;

 private:
  using Event = std::shared_ptr<const v1::WatchResponse>;
  class Watcher;

  void publish_until_end(double events_per_second);
  void add(Watcher* watcher);
  void remove(Watcher* watcher);

  std::atomic<bool> ending_ = false;
  std::mutex mutex_;
  std::set<Watcher*> watchers_;
  std::thread thread_;
};

}  // namespace axisgate::bench
