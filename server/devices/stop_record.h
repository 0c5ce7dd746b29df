// File with the open stops of a stage and the latch of its emergency stop, for the next run: valid after this run was
// killed, and after a boot of the machine.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "device/core/problem.h"
#include "device/stage/event.h"
#include "device/stage/unfinished.h"
#include "server/access/mapped_text.h"

namespace axisgate::server {

// Runs on the device's strand. No call waits for the disk: another thread syncs the file, so only a power cut directly
// after a stop loses it.
class StopRecord {
 public:
  // Fails with internal if the file cannot be created or is not a regular file.
  static Result<std::unique_ptr<StopRecord>> open(const std::string& path);
  ~StopRecord();
  StopRecord(const StopRecord&) = delete;
  StopRecord& operator=(const StopRecord&) = delete;

  // Open stops and the latch that the previous run left.
  const stage::Inheritance& before() const { return before_; }

  void on_event(const stage::Event& event);

 private:
  explicit StopRecord(std::unique_ptr<MappedText> file);
  void note(const stage::StopChanged& change);
  void note(const stage::EmergencyLatchChanged& change);
  template <class Other>
  void note(const Other&) {}
  void write();
  void sync_changes();

  const std::unique_ptr<MappedText> file_;
  stage::Inheritance before_;
  std::map<stage::StopId, stage::Stop> open_;
  stage::StopId last_ = 0;
  std::optional<stage::EmergencyLatch> latch_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool unsynced_ = false, ending_ = false;
  std::thread syncing_;
};

}  // namespace axisgate::server
