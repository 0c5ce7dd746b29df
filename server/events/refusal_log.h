// The log's lines on what was refused: bounded for each source, so that none can fill the disk or hide what others do.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "device/core/time.h"

namespace axisgate::server {

// Thread safe.
class RefusalLog {
 public:
  // Of one source, in the 10 s from its first line; how many more there were is one line when they are over.
  static constexpr Duration kWindow = std::chrono::seconds(10);
  static constexpr int kLines = 5;
  // So many are distinguished at a time. Those beyond have their lines together, as "other sources".
  static constexpr std::size_t kSources = 256;

  // `later` calls the task once when that time has passed, from any thread; perhaps after this has gone.
  using Later = std::function<void(Duration, std::function<void()>)>;
  explicit RefusalLog(Later later);
  // Says what is still unsaid.
  ~RefusalLog();
  RefusalLog(const RefusalLog&) = delete;
  RefusalLog& operator=(const RefusalLog&) = delete;

  // `source` is a short text that a caller cannot choose: "uid 1000", "192.168.0.7". `line` is fit for a log.
  void note(const std::string& source, const std::string& line);

 private:
  class Windows;

  const Later later_;
  const std::shared_ptr<Windows> windows_;
};

}  // namespace axisgate::server
