// One configured controller: its controller, the line under it, and what others may see of it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/link/runner.h"
#include "device/stage/kind.h"
#include "device/stage/stage_controller.h"
#include "server/access/leases.h"
#include "server/devices/device_events.h"
#include "server/devices/line.h"
#include "server/events/event_bus.h"
#include "server/events/newest.h"
#include "server/metrics/metrics.h"
#include "server/recording/recorder.h"

namespace axisgate::server {

// Who holds what of a device, and who waits.
struct LeaseBoard {
  std::vector<Lease> held;
  std::vector<WaitingLease> waiting;
  std::vector<Leases::HeldBack> held_back;
};

class Device {
 public:
  // `bus`, `metrics` and the strand's io_context outlive this.
  Device(const DeviceConfig& config, std::unique_ptr<Line> line, Strand strand, EventBus& bus, Metrics& metrics,
         const Executor& readers, LeaseTokens& lease_tokens);

  // From any thread.
  const std::string& name() const { return profile_.name; }
  const stage::Kind& kind() const { return kind_; }
  const stage::Profile& profile() const { return profile_; }
  const std::string& line_description() const { return line_->description(); }
  Line& line() { return *line_; }
  Newest<stage::State>& newest_state() { return newest_state_; }
  Newest<LeaseBoard>& newest_leases() { return newest_leases_; }
  DeviceRecorder& recorder() { return recorder_; }

  // Runs the request on the device's strand, from any thread. After shutdown() it is dropped.
  using Request = std::function<void(stage::StageController&, TimePoint)>;
  void post(Request request);

  // On the strand only: from within a posted request or a callback of the controller.
  std::uint64_t motion_revision(stage::MotionId motion) const { return events_.motion_revision(motion); }
  Leases& leases() { return leases_; }

  void start();
  // Calls `done` on the strand when every motion has its outcome and the line is closed: StageController::wind_down().
  // From any thread, once; not after shutdown().
  void wind_down(std::function<void()> done);
  void shutdown();

 private:
  void on_wound_down(const stage::WindDownReport& report);
  void on_due(DeviceEvents::Due due);
  void publish_due();

  const stage::Kind& kind_;
  const stage::Profile profile_;
  std::unique_ptr<Line> line_;
  Newest<stage::State> newest_state_;
  Newest<LeaseBoard> newest_leases_;
  DeviceMetrics metrics_;
  DeviceRecorder recorder_;
  DeviceEvents events_;
  Leases leases_;
  Runner runner_;
  std::unique_ptr<stage::StageController> controller_;
  bool publishing_ = false;  // a posted publish_due() is under way
  bool state_due_ = false;
};

}  // namespace axisgate::server
