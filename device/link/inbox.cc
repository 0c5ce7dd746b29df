#include "device/link/inbox.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "device/link/descriptor.h"

namespace axisgate {

class Inbox::Queue : public std::enable_shared_from_this<Queue> {
 public:
  explicit Queue(const Strand& strand);

  void post(std::function<void()> run, std::function<void()> too_late);
  void close();
  void wait();

 private:
  struct Task {
    std::function<void()> run;
    std::function<void()> too_late;
  };
  bool push(Task& task);
  std::optional<Task> take();
  void run();

  // An eventfd; outlives `reader_`, because a thread may still write to it after `reader_` was closed.
  const Descriptor bell_;
  std::uint64_t rings_ = 0;
  std::mutex mutex_;
  std::deque<Task> tasks_;
  std::optional<boost::asio::posix::stream_descriptor> reader_;  // reads bell_; nullopt once closed
};

namespace {

// Number of tasks after which the strand serves its lines.
constexpr int kTasksInTurn = 16;

Descriptor new_bell() {
  Descriptor bell(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
  if (!bell.valid()) throw boost::system::system_error(errno, boost::system::system_category(), "eventfd");
  return bell;
}

}  // namespace

Inbox::Queue::Queue(const Strand& strand) : bell_(new_bell()) { reader_.emplace(strand, bell_.get()); }

void Inbox::Queue::post(std::function<void()> run, std::function<void()> too_late) {
  Task task{std::move(run), std::move(too_late)};
  if (!push(task) && task.too_late) task.too_late();
}

// Returns false if the inbox is closed.
bool Inbox::Queue::push(Task& task) {
  {
    const std::lock_guard lock(mutex_);
    if (!reader_) return false;
    tasks_.push_back(std::move(task));
    if (tasks_.size() > 1) return true;  // the bell was rung for earlier tasks, which are not all taken
  }
  const std::uint64_t ring = 1;
  (void)!::write(bell_.get(), &ring, sizeof ring);  // fails only if the count is full, and then the bell rings anyway
  return true;
}

void Inbox::Queue::close() {
  std::deque<Task> dropped;
  {
    const std::lock_guard lock(mutex_);
    dropped.swap(tasks_);
    if (reader_) (void)reader_->release();
    reader_.reset();
  }
  for (const Task& task : dropped) {
    if (task.too_late) task.too_late();  // may post again
  }
}

void Inbox::Queue::wait() {
  reader_->async_read_some(boost::asio::buffer(&rings_, sizeof rings_),
                           [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
                             if (!error) self->run();
                           });
}

std::optional<Inbox::Queue::Task> Inbox::Queue::take() {
  const std::lock_guard lock(mutex_);
  if (tasks_.empty()) return std::nullopt;
  auto task = std::move(tasks_.front());
  tasks_.pop_front();
  return task;
}

void Inbox::Queue::run() {
  for (int done = 0; reader_ && done < kTasksInTurn; ++done) {
    const auto task = take();
    if (!task) return wait();
    task->run();
  }
  if (reader_) boost::asio::post(reader_->get_executor(), [self = shared_from_this()] { self->run(); });
}

Inbox::Inbox(const Strand& strand) : queue_(std::make_shared<Queue>(strand)) { queue_->wait(); }

Inbox::~Inbox() { close(); }

void Inbox::post(std::function<void()> task, std::function<void()> too_late) {
  queue_->post(std::move(task), std::move(too_late));
}

void Inbox::close() { queue_->close(); }

}  // namespace axisgate
