// A Device has a name, a line with its recorder, and leases; it starts, winds down and ends. Each kind of device, such
// as Stage, derives from Device.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "device/link/runner.h"
#include "device/stage/recording/recording.h"
#include "device/use/scope.h"
#include "server/access/leases.h"
#include "server/devices/line.h"
#include "server/events/newest.h"
#include "server/journal/journal.h"
#include "server/metrics/metrics.h"
#include "server/recording/recorder.h"

namespace axisgate::server {

// Holders of a device's axes, and waiting callers.
struct LeaseBoard {
  std::vector<Lease> held;
  std::vector<WaitingLease> waiting;
  std::vector<Leases::HeldBack> held_back;
};

class Device {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // These members may be called from any thread.
  const std::string& name() const { return name_; }
  virtual std::string_view kind_name() const = 0;  // value of `kind` in the configuration
  // Returns the scope of a lease that names no axes.
  virtual use::Scope whole() const = 0;
  const std::string& line_description() const { return line_->description(); }
  Line& line() { return *line_; }
  Newest<LeaseBoard>& newest_leases() { return newest_leases_; }
  DeviceRecorder& recorder() { return recorder_; }

  // Types for requests that every kind of device accepts.
  using Controller = Leases;
  using Request = std::function<void(Leases&, TimePoint)>;
  // Runs the request on the device's strand. After shutdown() `too_late` is called instead. May be called from any
  // thread.
  void post(Request request, std::function<void()> too_late = {});

  // Call on the device's strand only.
  Leases& leases() { return leases_; }

  void start();
  // Ends everything in progress, closes the line, and then calls `done` on the strand. May be called once, from any
  // thread, but not after shutdown().
  virtual void wind_down(std::function<void()> done) = 0;
  // Longest duration of wind_down(), not counting the last exchange on the line.
  virtual Duration wind_down_limit() const = 0;
  void shutdown();

 protected:
  // `metrics`, `lease_tokens`, `thread` and `journal` must outlive the device. If `journal` is null, nothing is kept.
  Device(std::string name, const stage::RecordingHeader& header, std::unique_ptr<Line> line, LineThread& thread,
         Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens, journal::Journal* journal);

  Runner& runner() { return runner_; }

 private:
  const std::string name_;
  std::unique_ptr<Line> line_;
  Newest<LeaseBoard> newest_leases_;
  DeviceRecorder recorder_;
  Leases leases_;
  Runner runner_;
};

}  // namespace axisgate::server
