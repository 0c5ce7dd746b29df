// Sends the events of one device to the event bus, the metrics, the recorder and the log.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "device/stage/event.h"
#include "server/devices/motion_record.h"
#include "server/devices/repeated_stops.h"
#include "server/devices/stop_record.h"
#include "server/events/event_bus.h"
#include "server/events/newest.h"
#include "server/journal/device_entries.h"
#include "server/metrics/stage_metrics.h"
#include "server/recording/recorder.h"

namespace axisgate::server {

// Runs on the device's strand, as EventSink demands.
class DeviceEvents : public stage::EventSink {
 public:
  // Part of the state that an event requires to be published after it: `queues`, or the whole `state`. With
  // `state_at_once` the state is published before the next answer, because the caller may read it. OnDue is called from
  // within on_event().
  enum class Due { queues, state, state_at_once };
  using OnDue = std::function<void(Due)>;

  // Places where events are kept; null: not kept.
  struct Keepers {
    MotionRecord* motions = nullptr;  // record for the next run
    StopRecord* stops = nullptr;      // record for the next run
    journal::DeviceEntries* entries = nullptr;
  };

  // The referenced objects must outlive this one.
  DeviceEvents(std::string device, EventBus& bus, StageMetrics& metrics, DeviceRecorder& recorder,
               const Newest<stage::State>& newest_state, OnDue due, Keepers keepers);

  void on_event(const stage::Event& event, TimePoint now) override;
  bool state_followed() const override { return newest_state_.has_subscribers(); }

  // Returns the revision of the newest fact about a motion; 0 if there is none or it is no longer remembered.
  std::uint64_t motion_revision(stage::MotionId motion) const;
  // Returns the clock by which the motion's times are shown. It is fixed at the first fact, so the times are the same
  // each time they are read, even if the calendar was set in between.
  Moment motion_clock(stage::MotionId motion) const;

 private:
  struct Known {
    std::uint64_t revision = 0;
    Moment clock;
  };
  // Number of motions remembered; higher than the number that the controller keeps.
  static constexpr std::size_t kMotionsRemembered = 4096;

  void tell(const stage::MotionChanged& change, TimePoint now);
  void tell(const stage::LinkChanged& change, TimePoint now);
  void tell(const stage::StopRequested& stop, TimePoint now);
  void tell(const stage::StopChanged& change, TimePoint now);
  void tell(const stage::EmergencyLatchChanged& change, TimePoint now);
  void tell(const stage::ForeignMotion& motion, TimePoint now);
  void tell(const stage::ConditionChanged& change, TimePoint now);
  void tell(const stage::UnfinishedJudged& judged, TimePoint now);
  void tell(const stage::SwitchesChanged& change, TimePoint now);
  void tell(const stage::ProgramNotice& notice, TimePoint now);
  void tell(const stage::CompletionSeen& completion, TimePoint now) { publish(completion, now); }
  void tell(const stage::PathProgress& progress, TimePoint now);
  void tell(const stage::BarrierEntered& barrier, TimePoint now);
  void tell(const stage::LineLearned&, TimePoint) {}
  void tell(const stage::UnexpectedLine& line, TimePoint now);
  void tell(const stage::IllegalTransition& fault, TimePoint now);
  void tell(const stage::BytesWritten&, TimePoint) {}
  void tell(const stage::BytesReceived&, TimePoint) {}
  void tell(const stage::TimeLimitPassed&, TimePoint) {}
  void tell(const stage::ExchangeEnded&, TimePoint) { due_(Due::queues); }
  void tell(const stage::StateChanged&, TimePoint) { due_(Due::state); }

  void keep_and_tell(const stage::Event& event, TimePoint now);
  bool is_folded(const stage::Event& event) const;
  bool is_known(const stage::Event& event);
  void publish(Fact fact, TimePoint now);

  const std::string device_;
  EventBus& bus_;
  StageMetrics& metrics_;
  DeviceRecorder& recorder_;
  const Newest<stage::State>& newest_state_;
  const OnDue due_;
  const Keepers keepers_;
  std::map<stage::MotionId, Known> motions_;
  RepeatedStops repeated_stops_;
  std::set<stage::StopId> late_;  // late stops that are open
  // Last reported change. Connecting to a line that stays down is tried again and again, and the same change is
  // reported once.
  std::optional<stage::LinkChanged> link_;
  // Limits the log to one unexpected line a second, with the number left out: a chattering line must not fill the disk.
  TimePoint next_unexpected_line_{};
  std::uint64_t unexpected_lines_unlogged_ = 0;
};

}  // namespace axisgate::server
