// Times at which lines were written, from the daemon's recording, converted to the clock of this program.
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

// Beginning and end of a call in this program, by monotonic_now(). Recordings use the same clock, but begin at an
// unknown time.
struct CallTimes {
  TimePoint called, ended;
};

// Times at which a line was written and the last byte of its reply was received, since the beginning of the recording.
struct RecordedTimes {
  Duration written, replied;
};

// A Recording follows the daemon's recording from its construction on.
class Recording {
 public:
  explicit Recording(const std::shared_ptr<grpc::Channel>& channel);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // Returns the times of all written lines that begin with `line_begin`.
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

// Beginning of the recording, computed from calls that each wrote one line: the line was written after the call began,
// and the reply was received before the call ended.
struct Beginning {
  TimePoint earliest, latest;
  TimePoint middle() const { return earliest + (latest - earliest) / 2; }
};
Beginning beginning_of(const std::vector<CallTimes>& calls, const std::vector<RecordedTimes>& recorded);

}  // namespace axisgate::bench
