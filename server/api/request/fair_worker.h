// Long tasks of many people on one thread.
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

// Thread safe. Runs one task at a time. Identities take turns, so that nobody waits for all that somebody else has
// requested. The tasks of one identity run in their order.
class FairWorker {
 public:
  using Task = std::function<void()>;

  FairWorker();
  ~FairWorker();

  // Runs what waits. What is posted afterwards is dropped.
  void join();

  // `identity`: server::identity_of() whom the task is for.
  void post(const std::string& identity, Task task);

 private:
  void run_next();

  std::mutex mutex_;
  std::map<std::string, std::deque<Task>> waiting_;         // by identity; none is empty
  std::deque<std::string> turns_;                           // of those in waiting_
  const std::unique_ptr<boost::asio::thread_pool> thread_;  // one thread
};

}  // namespace axisgate::api
