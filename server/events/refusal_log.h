// Log lines about refusals, limited for each source, so that no source can fill the disk or hide the refusals of
// others.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "device/core/time.h"
#include "server/limits.h"

namespace axisgate::server {

// Thread safe.
class RefusalLog {
 public:
  static constexpr int kLines = 5;
  // Number of sources logged separately; further ones share the label "other sources".
  static constexpr std::size_t kSources = 256;

  // Calls the task once after that time, from any thread, possibly after the RefusalLog is destroyed.
  using Later = std::function<void(Duration, std::function<void()>)>;
  explicit RefusalLog(Later later);
  // Logs the numbers of lines left out that were not logged yet.
  ~RefusalLog();
  RefusalLog(const RefusalLog&) = delete;
  RefusalLog& operator=(const RefusalLog&) = delete;

  // `source` is a short text that a caller cannot choose: "uid 1000", "192.168.0.7". `line` must be suitable for a log.
  void note(const std::string& source, const std::string& line);

 private:
  class Windows;

  const Later later_;
  const std::shared_ptr<Windows> windows_;
};

}  // namespace axisgate::server
