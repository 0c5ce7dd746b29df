#include "server/events/refusal_log.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "server/log.h"

namespace axisgate::server {
namespace {

constexpr const char* kOthers = "other sources";

}  // namespace

class RefusalLog::Windows {
 public:
  ~Windows() {
    for (const auto& [source, window] : open_) say_left_out(source, window);
  }

  // Logs or counts a line. Returns the source whose window begins with this line, or null.
  const std::string* note(const std::string& source, const std::string& line) {
    const std::lock_guard lock(mutex_);
    const bool distinguished = open_.contains(source) || open_.size() < kSources;
    const auto [entry, began] = open_.try_emplace(distinguished ? source : kOthers);
    Window& window = entry->second;
    if (window.lines < kLines) {
      ++window.lines;
      log::warn("{}", line);
    } else {
      ++window.left_out;
    }
    return began ? &entry->first : nullptr;
  }

  void close(const std::string& source) {
    const std::lock_guard lock(mutex_);
    const auto closed = open_.extract(source);
    say_left_out(closed.key(), closed.mapped());
  }

 private:
  struct Window {
    int lines = 0;
    std::uint64_t left_out = 0;
  };

  static void say_left_out(const std::string& source, const Window& window) {
    if (window.left_out == 0) return;
    log::warn("left out {} more refusals of {} in the last {} s", window.left_out, source,
              std::chrono::duration_cast<std::chrono::seconds>(kRefusalLogWindow).count());
  }

  std::mutex mutex_;
  std::map<std::string, Window> open_;
};

RefusalLog::RefusalLog(Later later) : later_(std::move(later)), windows_(std::make_shared<Windows>()) {}

RefusalLog::~RefusalLog() = default;

void RefusalLog::note(const std::string& source, const std::string& line) {
  const std::string* const began = windows_->note(source, line);
  if (began == nullptr) return;
  later_(kRefusalLogWindow, [windows = std::weak_ptr(windows_), source = *began] {
    if (const auto still = windows.lock()) still->close(source);
  });
}

}  // namespace axisgate::server
