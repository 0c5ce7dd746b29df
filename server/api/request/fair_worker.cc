#include "server/api/request/fair_worker.h"

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <utility>

namespace axisgate::api {

FairWorker::FairWorker() : thread_(std::make_unique<boost::asio::thread_pool>(1)) {}

FairWorker::~FairWorker() { join(); }

void FairWorker::join() { thread_->join(); }

void FairWorker::post(const std::string& identity, Task task) {
  {
    const std::lock_guard lock(mutex_);
    std::deque<Task>& own = waiting_[identity];
    if (own.empty()) turns_.push_back(identity);
    own.push_back(std::move(task));
  }
  boost::asio::post(*thread_, [this] { run_next(); });
}

void FairWorker::run_next() {
  std::unique_lock lock(mutex_);
  const auto own = waiting_.find(turns_.front());
  turns_.pop_front();
  const Task task = std::move(own->second.front());
  own->second.pop_front();
  if (own->second.empty()) {
    waiting_.erase(own);
  } else {
    turns_.push_back(own->first);
  }
  lock.unlock();
  task();
}

}  // namespace axisgate::api
