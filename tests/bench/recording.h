// What was written to the line and when, as the daemon's recording has it, on this program's clock.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "axisgate/v1/diagnostics.grpc.pb.h"
#include "device/core/time.h"

namespace axisgate::bench {

// When a call began and ended here, by monotonic_now(): the clock of recordings, which begin at an unknown time.
struct CallTimes {
  TimePoint called, ended;
};

// When a line was written, and when the last byte of its reply was received, since the recording's beginning.
struct RecordedTimes {
  Duration written, replied;
};

// Follows the recording from now on.
class Recording {
 public:
  explicit Recording(const std::shared_ptr<grpc::Channel>& channel);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // Of all written lines that begin so.
  std::vector<RecordedTimes> times_of(std::string_view line_begin) const;

 private:
  void read();

  std::unique_ptr<v1::DiagnosticsService::Stub> stub_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::RecordResponse>> reader_;
  mutable std::mutex mutex_;
  std::string text_;
  std::thread thread_;
};

// When the recording began, as precisely as it follows from calls of which each had one line written: that happened
// after the call began, and the reply was received before it ended.
struct Beginning {
  TimePoint earliest, latest;
  TimePoint middle() const { return earliest + (latest - earliest) / 2; }
};
Beginning beginning_of(const std::vector<CallTimes>& calls, const std::vector<RecordedTimes>& recorded);

}  // namespace axisgate::bench
