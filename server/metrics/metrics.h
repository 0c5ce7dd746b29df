// What Prometheus may know: fixed names, fixed label sets, one time series per device and table entry.
#pragma once

#include <prometheus/collectable.h>
#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "device/core/lane.h"
#include "device/core/problem.h"
#include "device/stage/event.h"
#include "server/config/config.h"
#include "server/metrics/page_limits.h"

namespace axisgate::server {

class MetricsPage;

// The families, one for the daemon. Thread safe once constructed, but for expose() and add(), which are one thread's.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  // Serves /metrics at the address and returns the port taken, or says why not (a port in use). Call it once.
  Result<int> expose(const TcpAddress& address, const PageLimits& limits = {});

  // Stands on the page, too: for what is not counted but asked when the page is. Kept as long as the page, so that
  // the page's thread is not the last to hold it.
  void add(std::shared_ptr<prometheus::Collectable> part);

  const std::shared_ptr<prometheus::Registry>& registry() const { return registry_; }

  prometheus::Counter& slow_readers() { return slow_readers_; }

 private:
  friend class DeviceMetrics;

  std::string text();

  std::shared_ptr<prometheus::Registry> registry_;
  prometheus::Family<prometheus::Counter>& exchanges_;
  prometheus::Family<prometheus::Histogram>& exchange_seconds_;
  prometheus::Family<prometheus::Gauge>& queue_depth_;
  prometheus::Family<prometheus::Histogram>& queue_wait_;
  prometheus::Family<prometheus::Counter>& line_busy_;
  prometheus::Family<prometheus::Counter>& line_bytes_;
  prometheus::Family<prometheus::Counter>& time_limits_;
  prometheus::Family<prometheus::Gauge>& outstanding_answers_;
  prometheus::Family<prometheus::Counter>& completions_;
  prometheus::Family<prometheus::Counter>& motions_;
  prometheus::Family<prometheus::Counter>& stops_;
  prometheus::Family<prometheus::Gauge>& positions_;
  prometheus::Family<prometheus::Gauge>& link_up_;
  prometheus::Family<prometheus::Counter>& barriers_;
  prometheus::Family<prometheus::Counter>& underruns_;
  prometheus::Family<prometheus::Counter>& unexpected_lines_;
  prometheus::Family<prometheus::Counter>& recorder_drops_;
  prometheus::Counter& slow_readers_;
  std::mutex parts_mutex_;
  std::vector<std::shared_ptr<prometheus::Collectable>> parts_;
  std::unique_ptr<MetricsPage> page_;  // last: its thread uses the others
};

// One device's time series, their handles kept. Called on the device's strand; `metrics` outlives it.
class DeviceMetrics {
 public:
  DeviceMetrics(Metrics& metrics, std::string device);

  void on_event(const stage::Event& event);
  void set_state(const stage::State& state);
  void set_queued(Lane lane, std::size_t commands);
  void set_outstanding_answers(int answers) { outstanding_answers_.Set(answers); }
  void count_recorder_drops(std::uint64_t lines) {
    recorder_drops_.Increment(static_cast<double>(lines));
  }  // any thread

 private:
  static constexpr std::size_t kOutcomeCount = 8;
  struct CommandSeries {
    std::array<prometheus::Counter*, kOutcomeCount> outcomes{};
    prometheus::Histogram* seconds = nullptr;
  };

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
  void count(const stage::ForeignMotion&) {}
  void count(const stage::SwitchesChanged&) {}
  void count(const stage::ProgramNotice&) {}
  void count(const stage::LinkChanged& change);
  void count(const stage::BarrierEntered&) { barriers_.Increment(); }
  void count(const stage::LineLearned&) {}
  void count(const stage::UnexpectedLine&) { unexpected_lines_.Increment(); }
  void count(const stage::IllegalTransition&) {}
  void count(const stage::UnfinishedJudged&) {}
  void count(const stage::StateChanged&) {}
  prometheus::Counter& motions(stage::MotionKind kind, stage::MotionState outcome);

  Metrics& metrics_;
  const std::string device_;
  std::unordered_map<std::string_view, CommandSeries> commands_;  // keys are the command table's own names
  std::array<prometheus::Gauge*, kLaneCount> lanes_{};
  std::array<prometheus::Histogram*, kLaneCount> waits_{};
  std::array<prometheus::Counter*, 3> time_limits_{};  // by TimeLimitPassed::Kind
  std::array<prometheus::Counter*, stage::kAxisCount> completions_{};
  std::array<prometheus::Gauge*, stage::kAxisCount> positions_{};  // null until a position is known
  prometheus::Counter& normal_stops_;
  prometheus::Counter& emergency_stops_;
  prometheus::Gauge& link_up_;
  prometheus::Counter& barriers_;
  prometheus::Counter& underruns_;
  prometheus::Counter& unexpected_lines_;
  prometheus::Counter& recorder_drops_;
  prometheus::Counter& line_busy_;
  prometheus::Counter& bytes_in_;
  prometheus::Counter& bytes_out_;
  prometheus::Gauge& outstanding_answers_;
};

}  // namespace axisgate::server
