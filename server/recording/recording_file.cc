#include "server/recording/recording_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <utility>

#include "server/log.h"

namespace axisgate::server {
namespace {

constexpr const char* kBeforeSuffix = ".1";
constexpr mode_t kMode = 0640;  // restricted, because the file shows who requested what

}  // namespace

RecordingFile::RecordingFile(std::string path, DeviceRecorder& recorder, std::uint64_t bytes_max, Duration retry_pause,
                             RecordingRing::Beginning beginning)
    : recorder_(recorder),
      path_(std::move(path)),
      bytes_max_(bytes_max),
      retry_pause_(retry_pause),
      reader_(recorder, beginning.position),
      due_(std::move(beginning.header)),
      subscription_(recorder.subscribe([this] {
        {
          const std::lock_guard lock(mutex_);
          pending_ = true;
        }
        changed_.notify_all();
      })),
      thread_([this] { run(); }) {}

RecordingFile::~RecordingFile() {
  subscription_.reset();
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void RecordingFile::run() {
  for (bool more = true; more;) {
    more = wait();
    if (!file_.valid() && !open()) continue;
    do {
      if (due_.empty() && size_ >= bytes_max_ / 2) begin_another();
      if (due_.empty()) due_ = reader_.next();
    } while (!due_.empty() && file_.valid() && write_due());
  }
}

// Waits for lines to write or, after an error, for the retry pause. Returns false if this is the last round.
bool RecordingFile::wait() {
  std::unique_lock lock(mutex_);
  if (complaint_.empty()) {
    changed_.wait(lock, [this] { return pending_ || ending_; });
  } else {
    changed_.wait_for(lock, retry_pause_, [this] { return ending_; });
  }
  pending_ = false;
  return !ending_;
}

bool RecordingFile::open() {
  file_ = Descriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, kMode));
  if (!file_.valid()) {
    complain("opened");
    return false;
  }
  // A daemon that was killed may have left an incomplete line; the header must start on a new one.
  size_ = static_cast<std::uint64_t>(std::max<off_t>(0, ::lseek(file_.get(), 0, SEEK_END)));
  if (size_ > 0) due_.insert(0, "\n");
  return true;
}

// Both files contain the lines that the ring keeps, so that each is a complete recording.
void RecordingFile::begin_another() {
  const std::string before = path_ + kBeforeSuffix;
  if (::rename(path_.c_str(), before.c_str()) != 0) return complain("renamed");
  RecordingRing::Beginning beginning = recorder_.ring().oldest();
  reader_ = {recorder_, beginning.position};
  due_ = std::move(beginning.header);
  open();
}

bool RecordingFile::write_due() {
  while (!due_.empty()) {
    const ssize_t written = ::write(file_.get(), due_.data(), due_.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      complain("written to");
      return false;
    }
    due_.erase(0, static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
  if (!complaint_.empty()) log::info("the recording {} is written again", path_);
  complaint_.clear();
  return true;
}

void RecordingFile::complain(const char* what) {
  std::string complaint = fmt::format("the recording {} cannot be {}: {}", path_, what, std::strerror(errno));
  if (complaint != complaint_) log::warn("{}; trying again", complaint);
  complaint_ = std::move(complaint);
}

}  // namespace axisgate::server
