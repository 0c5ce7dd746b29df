// Metrics of a stage: its line, its commands and its motions.
#pragma once

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "device/core/lane.h"
#include "device/stage/event.h"

namespace axisgate::server {

// The time series of one stage. Called on the device's strand; `registry` must outlive this object.
class StageMetrics {
 public:
  StageMetrics(prometheus::Registry& registry, std::string device, int axis_count);

  void on_event(const stage::Event& event);
  void set_state(const stage::State& state);
  void set_queued(Lane lane, std::size_t commands);
  void set_outstanding_answers(int answers) { outstanding_answers_.Set(answers); }

 private:
  struct Families;
  static constexpr std::size_t kOutcomeCount = 8;
  struct CommandSeries {
    std::array<prometheus::Counter*, kOutcomeCount> outcomes{};
    prometheus::Histogram* seconds = nullptr;
  };

  StageMetrics(const Families& families, std::string device, int axis_count);

  void count(const stage::ExchangeEnded& exchange);
  void count(const stage::BytesWritten& written) { bytes_out_.Increment(static_cast<double>(written.bytes.size())); }
  void count(const stage::BytesReceived& received) { bytes_in_.Increment(static_cast<double>(received.bytes.size())); }
  void count(const stage::TimeLimitPassed& limit) {
    time_limits_.at(static_cast<std::size_t>(limit.kind))->Increment();
  }
  void count(const stage::MotionChanged& change);
  void count(const stage::CompletionSeen& completion);
  void count(const stage::PathProgress& progress);
  void count(const stage::StopRequested& stop);
  void count(const stage::StopChanged& change);
  void count(const stage::EmergencyLatchChanged&) {}
  void count(const stage::ForeignMotion&) {}
  void count(const stage::ConditionChanged& change);
  void count(const stage::SwitchesChanged&) {}
  void count(const stage::ProgramNotice&) {}
  void count(const stage::LinkChanged& change);
  void set_link(stage::LinkState link);
  void count(const stage::BarrierEntered&) { barriers_.Increment(); }
  void count(const stage::LineLearned&) {}
  void count(const stage::UnexpectedLine&) { unexpected_lines_.Increment(); }
  void count(const stage::IllegalTransition&) {}
  void count(const stage::UnfinishedJudged&) {}
  void count(const stage::StateChanged&) {}
  prometheus::Counter& motions(stage::MotionKind kind, stage::MotionState outcome);

  const std::string device_;
  // The series of these families are looked up, or made, at each event.
  prometheus::Family<prometheus::Counter>& exchanges_;
  prometheus::Family<prometheus::Histogram>& exchange_seconds_;
  prometheus::Family<prometheus::Counter>& motions_;
  prometheus::Family<prometheus::Gauge>& positions_family_;
  std::unordered_map<std::string_view, CommandSeries> commands_;  // keys are the command table's own names
  std::array<prometheus::Gauge*, kLaneCount> lanes_{};
  std::array<prometheus::Histogram*, kLaneCount> waits_{};
  std::array<prometheus::Counter*, 3> time_limits_{};            // by TimeLimitPassed::Kind
  std::vector<prometheus::Counter*> completions_;                // by axis
  std::map<stage::Condition, prometheus::Counter*> conditions_;  // the reported conditions
  std::vector<prometheus::Gauge*> positions_;                    // by axis; null until a position is known
  prometheus::Counter& normal_stops_;
  prometheus::Counter& emergency_stops_;
  prometheus::Gauge& open_stops_;
  prometheus::Gauge& late_stops_;
  prometheus::Histogram& stop_seconds_;
  prometheus::Gauge& emergency_latched_;
  prometheus::Gauge& link_up_;
  prometheus::Gauge& line_babbles_;
  prometheus::Counter& barriers_;
  prometheus::Counter& underruns_;
  prometheus::Counter& unexpected_lines_;
  prometheus::Counter& line_busy_;
  prometheus::Counter& bytes_in_;
  prometheus::Counter& bytes_out_;
  prometheus::Gauge& outstanding_answers_;
};

}  // namespace axisgate::server
