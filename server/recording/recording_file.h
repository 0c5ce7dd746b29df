// A file to which the daemon records a device's line.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "device/core/time.h"
#include "device/link/descriptor.h"
#include "server/limits.h"
#include "server/recording/recorder.h"

namespace axisgate::server {

// A RecordingFile reads the recording like any reader and appends it to the file on a separate thread. A slow or full
// disk delays nothing else; lost lines are noted in the file and counted. A file that cannot be written is tried again
// every few seconds, and the log gives the reason. At half of `bytes_max`, the file is renamed to PATH.1, replacing the
// previous PATH.1, and a new file begins with the lines that the ring keeps.
class RecordingFile {
 public:
  // Records all lines that the ring keeps, and all later ones. `recorder` must outlive this object.
  RecordingFile(std::string path, DeviceRecorder& recorder, std::uint64_t bytes_max,
                Duration retry_pause = kRecordingRetryPause)
      : RecordingFile(std::move(path), recorder, bytes_max, retry_pause, recorder.ring().oldest()) {}
  // Writes the remaining lines, if the file can be written.
  ~RecordingFile();

 private:
  RecordingFile(std::string path, DeviceRecorder& recorder, std::uint64_t bytes_max, Duration retry_pause,
                RecordingRing::Beginning beginning);
  void run();
  bool wait();
  bool open();
  void begin_another();
  bool write_due();
  void complain(const char* what);

  DeviceRecorder& recorder_;
  const std::string path_;
  const std::uint64_t bytes_max_;  // of both files together
  const Duration retry_pause_;
  DeviceRecorder::Reader reader_;
  Descriptor file_;
  std::uint64_t size_ = 0;
  std::string due_;        // read, but not written yet
  std::string complaint_;  // newest complaint in the log; empty: no error
  std::mutex mutex_;
  std::condition_variable changed_;
  bool pending_ = true;
  bool ending_ = false;
  std::unique_ptr<WakeUps::Subscription> subscription_;
  std::thread thread_;
};

}  // namespace axisgate::server
