#include "server/metrics/metrics.h"

#include <fmt/format.h>
#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <utility>
#include <variant>

#include "server/metrics/metrics_page.h"

namespace axisgate::server {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;

Family<Counter>& counter(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

Family<Gauge>& gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry);
}

// Seconds. A question and its reply take 12 ms at 38400 baud, 46 ms at 9600; the reply's time limit is 0.5 s, 5 s for
// a few commands.
const Histogram::BucketBoundaries kExchangeSeconds = {0.0005, 0.001, 0.002, 0.005, 0.01, 0.02,
                                                      0.05,   0.1,   0.2,   0.5,   1,    5};

// Seconds. On an idle line a command waits for nothing, behind one exchange some 12 ms, behind a barrier up to 2 s.
const Histogram::BucketBoundaries kQueueWaitSeconds = {0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10};

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

Metrics::Metrics()
    : registry_(std::make_shared<prometheus::Registry>()),
      exchanges_(counter(*registry_, "axisgate_exchanges_total",
                         "Commands sent over the line, by how the exchange ended: ok, ok_d, ng and ng_i are the "
                         "controller's answers, data is an answered question.")),
      exchange_seconds_(prometheus::BuildHistogram()
                            .Name("axisgate_exchange_seconds")
                            .Help("Time from writing a command to the last byte of its reply.")
                            .Register(*registry_)),
      queue_depth_(gauge(*registry_, "axisgate_queue_depth", "Commands that wait for the line.")),
      queue_wait_(prometheus::BuildHistogram()
                      .Name("axisgate_queue_wait_seconds")
                      .Help("Time from asking for a command to writing it, by lane.")
                      .Register(*registry_)),
      line_busy_(
          counter(*registry_, "axisgate_line_busy_seconds_total",
                  "Time during which a command had been written and its reply was awaited; its rate is the share "
                  "of the line that is used.")),
      line_bytes_(
          counter(*registry_, "axisgate_line_bytes_total", "Bytes on the line, out to the controller and in from it.")),
      time_limits_(
          counter(*registry_, "axisgate_time_limits_total",
                  "Time limits that passed: of a reply, of a probe in a barrier, or of a command in its queue.")),
      outstanding_answers_(gauge(*registry_, "axisgate_outstanding_answers",
                                 "Answers to abandoned probes that may still come, and will be dropped.")),
      completions_(counter(*registry_, "axisgate_completions_total",
                           "Axis numbers that came over the line by themselves: the axis said that it arrived.")),
      motions_(counter(*registry_, "axisgate_motions_total", "Motions that ended, by kind and outcome.")),
      stops_(counter(*registry_, "axisgate_stops_total",
                     "Stops requested: slowing down (normal, L:) or at once and latched (emergency, L:E).")),
      positions_(gauge(*registry_, "axisgate_position_pulses",
                       "Command counter of an axis in pulses, as last read; NaN when it is not known.")),
      link_up_(gauge(*registry_, "axisgate_link_up", "1 when the configured controller answers, else 0.")),
      barriers_(counter(*registry_, "axisgate_barriers_total",
                        "How often the gateway matched replies and commands again after a timeout or garbage.")),
      underruns_(counter(*registry_, "axisgate_underruns_total",
                         "Path segments that came after the chain had ended: OK where OK_D was due.")),
      unexpected_lines_(counter(*registry_, "axisgate_unexpected_lines_total",
                                "Lines from the controller that nothing waited for; they are dropped.")),
      recorder_drops_(counter(*registry_, "axisgate_recorder_dropped_total",
                              "Recorded lines that a reader of the recording, or its file, was too slow for.")),
      slow_readers_(counter(*registry_, "axisgate_slow_readers_total",
                            "Times that the reader of a stream fell behind the facts that are kept, and missed some.")
                        .Add({})),
      parts_{registry_} {
  gauge(*registry_, "axisgate_build_info", "1; the labels say what runs.")
      .Add({{"version", AXISGATE_VERSION}, {"compiler", AXISGATE_COMPILER}})
      .Set(1);
}

Metrics::~Metrics() = default;

Result<int> Metrics::expose(const TcpAddress& address, const PageLimits& limits) {
  auto page = MetricsPage::open(
      address, [this] { return text(); }, limits);
  if (!page) {
    // Its own problem names the key of another address.
    return fail(Reason::internal,
                fmt::format("cannot serve metrics on {}: the port is in use or not permitted", to_string(address)),
                "stop the program that holds it, or set another address with the key `metrics` in the configuration");
  }
  page_ = *std::move(page);
  return page_->address().port;
}

void Metrics::add(std::shared_ptr<prometheus::Collectable> part) {
  const std::lock_guard lock(parts_mutex_);
  parts_.push_back(std::move(part));
}

std::string Metrics::text() {
  // A part may take its time; nobody who adds another waits for it.
  const auto parts = [this] {
    const std::lock_guard lock(parts_mutex_);
    return parts_;
  }();
  std::vector<prometheus::MetricFamily> families;
  for (const auto& part : parts) std::ranges::move(part->Collect(), std::back_inserter(families));
  return prometheus::TextSerializer().Serialize(families);
}

DeviceMetrics::DeviceMetrics(Metrics& metrics, std::string device)
    : metrics_(metrics),
      device_(std::move(device)),
      normal_stops_(metrics.stops_.Add({{"device", device_}, {"kind", "normal"}})),
      emergency_stops_(metrics.stops_.Add({{"device", device_}, {"kind", "emergency"}})),
      link_up_(metrics.link_up_.Add({{"device", device_}})),
      barriers_(metrics.barriers_.Add({{"device", device_}})),
      underruns_(metrics.underruns_.Add({{"device", device_}})),
      unexpected_lines_(metrics.unexpected_lines_.Add({{"device", device_}})),
      recorder_drops_(metrics.recorder_drops_.Add({{"device", device_}})),
      line_busy_(metrics.line_busy_.Add({{"device", device_}})),
      bytes_in_(metrics.line_bytes_.Add({{"device", device_}, {"direction", "in"}})),
      bytes_out_(metrics.line_bytes_.Add({{"device", device_}, {"direction", "out"}})),
      outstanding_answers_(metrics.outstanding_answers_.Add({{"device", device_}})) {
  using Limit = stage::TimeLimitPassed::Kind;
  for (const Limit kind : {Limit::reply, Limit::probe, Limit::queue}) {
    time_limits_.at(static_cast<std::size_t>(kind)) =
        &metrics.time_limits_.Add({{"device", device_}, {"kind", std::string(stage::name(kind))}});
  }
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
    const prometheus::Labels labels{{"device", device_}, {"lane", std::string(kLaneNames[lane])}};
    lanes_[lane] = &metrics.queue_depth_.Add(labels);
    waits_[lane] = &metrics.queue_wait_.Add(labels, kQueueWaitSeconds);
  }
  for (std::size_t axis = 0; axis < completions_.size(); ++axis) {
    completions_[axis] = &metrics.completions_.Add({{"device", device_}, {"axis", std::to_string(axis + 1)}});
  }
  // Made now, so that the first of a kind is an increase, too.
  using stage::MotionKind, stage::MotionState;
  for (const MotionKind kind : {MotionKind::move, MotionKind::home, MotionKind::return_to_origin, MotionKind::path,
                                MotionKind::execute, MotionKind::jog, MotionKind::scan}) {
    for (const MotionState outcome :
         {MotionState::succeeded, MotionState::stopped, MotionState::failed, MotionState::unknown}) {
      motions(kind, outcome);
    }
  }
}

Counter& DeviceMetrics::motions(stage::MotionKind kind, stage::MotionState outcome) {
  return metrics_.motions_.Add(
      {{"device", device_}, {"kind", std::string(stage::name(kind))}, {"outcome", std::string(stage::name(outcome))}});
}

void DeviceMetrics::on_event(const stage::Event& event) {
  std::visit([this](const auto& what) { count(what); }, event);
}

void DeviceMetrics::set_state(const stage::State& state) {
  link_up_.Set(state.link == stage::LinkState::up ? 1 : 0);
  for (std::size_t axis = 0; axis < positions_.size(); ++axis) {
    const std::optional<std::int64_t>& position = state.axes[axis].position_pulses;
    if (positions_[axis] == nullptr) {
      if (!position) continue;
      positions_[axis] = &metrics_.positions_.Add({{"device", device_}, {"axis", std::to_string(axis + 1)}});
    }
    // A gauge is a double: exact up to 2^53 pulses, and the counter has ten digits.
    positions_[axis]->Set(position ? static_cast<double>(*position) : std::numeric_limits<double>::quiet_NaN());
  }
}

void DeviceMetrics::set_queued(Lane lane, std::size_t commands) {
  lanes_[static_cast<std::size_t>(lane)]->Set(static_cast<double>(commands));
}

void DeviceMetrics::count(const stage::ExchangeEnded& exchange) {
  CommandSeries& series = commands_[exchange.command];
  Counter*& outcome = series.outcomes[static_cast<std::size_t>(exchange.outcome)];
  if (outcome == nullptr) {
    outcome = &metrics_.exchanges_.Add({{"device", device_},
                                        {"command", std::string(exchange.command)},
                                        {"outcome", std::string(stage::name(exchange.outcome))}});
  }
  outcome->Increment();
  if (series.seconds == nullptr) {
    series.seconds = &metrics_.exchange_seconds_.Add({{"device", device_}, {"command", std::string(exchange.command)}},
                                                     kExchangeSeconds);
  }
  series.seconds->Observe(seconds(exchange.latency));
  waits_[static_cast<std::size_t>(exchange.lane)]->Observe(seconds(exchange.waited));
  line_busy_.Increment(seconds(exchange.latency));
}

void DeviceMetrics::count(const stage::MotionChanged& change) {
  // Once a motion: the family finds its series again by itself.
  if (stage::is_outcome(change.motion.state)) motions(change.motion.kind, change.motion.state).Increment();
}

void DeviceMetrics::count(const stage::CompletionSeen& completion) {
  completions_.at(static_cast<std::size_t>(completion.axis - 1))->Increment();
}

void DeviceMetrics::count(const stage::PathProgress& progress) {
  if (progress.step == stage::PathProgress::Step::underrun) underruns_.Increment();
}

void DeviceMetrics::count(const stage::StopRequested& stop) {
  (stop.emergency ? emergency_stops_ : normal_stops_).Increment();
}

void DeviceMetrics::count(const stage::LinkChanged& change) {
  link_up_.Set(change.link == stage::LinkState::up ? 1 : 0);
}

}  // namespace axisgate::server
