// A stage is a device whose controller moves axes. This file has its controller and its published state.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "device/stage/kind.h"
#include "device/stage/stage_controller.h"
#include "server/config/config.h"
#include "server/devices/device.h"
#include "server/devices/device_events.h"
#include "server/devices/motion_record.h"
#include "server/devices/stop_record.h"
#include "server/events/event_bus.h"
#include "server/journal/device_entries.h"
#include "server/metrics/stage_metrics.h"

namespace axisgate::server {

class Stage final : public Device {
 public:
  using Controller = stage::StageController;

  // `bus`, `metrics`, `thread` and `requests` must outlive the stage. `record`, `stops` and `journal` may be null. If
  // there is a journal, the numbers of motions continue after the highest in the journal and the record.
  Stage(const DeviceConfig& device, const StageConfig& config, std::unique_ptr<Line> line, LineThread& thread,
        EventBus& bus, Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens,
        std::unique_ptr<MotionRecord> record, std::unique_ptr<StopRecord> stops, journal::Journal* journal,
        journal::RequestMemory& requests);

  // These members may be called from any thread.
  std::string_view kind_name() const override { return kind_.name(); }
  use::Scope whole() const override { return stage::AxisSet::first(kind_.axis_count()); }
  const stage::Kind& kind() const { return kind_; }
  const stage::Profile& profile() const { return profile_; }
  Newest<stage::State>& newest_state() { return newest_state_; }
  const Newest<stage::State>& newest_state() const { return newest_state_; }

  // Runs the request on the device's strand. After shutdown() `too_late` is called instead. May be called from any
  // thread.
  using Request = std::function<void(stage::StageController&, TimePoint)>;
  void post(Request request, std::function<void()> too_late = {});

  // Call on the strand only: from within a posted request or a callback of the controller.
  std::uint64_t motion_revision(stage::MotionId motion) const { return events_.motion_revision(motion); }
  Moment motion_clock(stage::MotionId motion) const { return events_.motion_clock(motion); }

  // Returns MotionRecord::started_before(); nullopt if nothing is known of the previous run. Call before start().
  std::optional<StartedMotions> started_before() const;

  // Calls `done` when every motion has its outcome and the line is closed; see StageController::wind_down().
  void wind_down(std::function<void()> done) override;
  Duration wind_down_limit() const override;

 private:
  void inherit();
  void number_motions_after(const journal::Journal& journal);
  void on_wound_down(const stage::WindDownReport& report);
  void on_due(DeviceEvents::Due due);
  void publish_due();

  const stage::Kind& kind_;
  const stage::Profile profile_;
  Newest<stage::State> newest_state_;
  StageMetrics metrics_;
  const std::unique_ptr<MotionRecord> record_;
  const std::unique_ptr<StopRecord> stops_;
  journal::DeviceEntries entries_;
  DeviceEvents events_;
  std::unique_ptr<stage::StageController> controller_;
  bool due_ = false;  // publish_due() has something to do
  bool state_due_ = false;
};

}  // namespace axisgate::server
