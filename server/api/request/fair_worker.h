// Worker thread for long tasks of many callers.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace boost::asio {
class thread_pool;
}

namespace axisgate::api {

// Thread safe. Runs one task at a time. Identities take turns, so that no caller waits for all tasks of another. The
// tasks of one identity run in their order.
class FairWorker {
 public:
  using Task = std::function<void()>;

  FairWorker();
  ~FairWorker();

  // Runs the waiting tasks. Tasks that are posted afterwards are dropped.
  void join();

  // `identity` is the server::identity_of() of the caller who requested the task.
  void post(const std::string& identity, Task task);

 private:
  void run_next();

  std::mutex mutex_;
  std::map<std::string, std::deque<Task>> waiting_;         // by identity; no queue is empty
  std::deque<std::string> turns_;                           // identities in waiting_, next turn first
  const std::unique_ptr<boost::asio::thread_pool> thread_;  // one thread
};

}  // namespace axisgate::api
