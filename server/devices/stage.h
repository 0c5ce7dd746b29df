// A stage: a device whose controller moves axes. Its controller, and what others may see of its state.
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

  // `bus`, `metrics`, `thread` and `requests` outlive this. `record`, `stops` and `journal` may be null. With a
  // journal, motions are numbered on from the last that it has, or the record.
  Stage(const DeviceConfig& device, const StageConfig& config, std::unique_ptr<Line> line, LineThread& thread,
        EventBus& bus, Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens,
        std::unique_ptr<MotionRecord> record, std::unique_ptr<StopRecord> stops, journal::Journal* journal,
        journal::RequestMemory& requests);

  // From any thread.
  std::string_view kind_name() const override { return kind_.name(); }
  const stage::Kind& kind() const { return kind_; }
  const stage::Profile& profile() const { return profile_; }
  Newest<stage::State>& newest_state() { return newest_state_; }

  // Runs the request on the device's strand, from any thread. After shutdown() `too_late` is called in its place.
  using Request = std::function<void(stage::StageController&, TimePoint)>;
  void post(Request request, std::function<void()> too_late = {});

  // On the strand only: from within a posted request or a callback of the controller.
  std::uint64_t motion_revision(stage::MotionId motion) const { return events_.motion_revision(motion); }
  Moment motion_clock(stage::MotionId motion) const { return events_.motion_clock(motion); }

  // Of the run before: MotionRecord::started_before(). Nothing, where nothing is known of it. Before start().
  std::optional<StartedMotions> started_before() const;

  // `done` comes when every motion has its outcome and the line is closed: StageController::wind_down().
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
