#include "server/metrics/stage_metrics.h"

#include <prometheus/histogram.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "server/metrics/families.h"

namespace axisgate::server {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;

// In seconds. A question and its reply take 12 ms at 38400 baud, 46 ms at 9600; the reply's time limit is 0.5 s, 5 s
// for a few commands.
const Histogram::BucketBoundaries kExchangeSeconds = {0.0005, 0.001, 0.002, 0.005, 0.01, 0.02,
                                                      0.05,   0.1,   0.2,   0.5,   1,    5};

// In seconds. A command does not wait on an idle line; it waits about 12 ms after one exchange, up to 2 s after a
// barrier.
const Histogram::BucketBoundaries kQueueWaitSeconds = {0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10};

// In seconds. Axes slow down for up to 1 s (manual 89) D:); a line that is cut can keep a stop open for hours.
const Histogram::BucketBoundaries kStopSeconds = {0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 60, 600, 3600};

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

struct StageMetrics::Families {
  explicit Families(prometheus::Registry& registry)
      : exchanges(
            counter_family(registry, "axisgate_exchanges_total",
                           "Commands sent over the line, by how the exchange ended: ok, ok_d, ng and ng_i are the "
                           "controller's answers, data is an answered question.")),
        exchange_seconds(prometheus::BuildHistogram()
                             .Name("axisgate_exchange_seconds")
                             .Help("Time from writing a command to the last byte of its reply.")
                             .Register(registry)),
        queue_depth(gauge_family(registry, "axisgate_queue_depth", "Commands that wait for the line.")),
        queue_wait(prometheus::BuildHistogram()
                       .Name("axisgate_queue_wait_seconds")
                       .Help("Time from asking for a command to writing it, by lane.")
                       .Register(registry)),
        line_busy(counter_family(
            registry, "axisgate_line_busy_seconds_total",
            "Time during which a command had been written and its reply was awaited; its rate is the share "
            "of the line that is used.")),
        line_bytes(counter_family(registry, "axisgate_line_bytes_total",
                                  "Bytes on the line, out to the controller and in from it.")),
        time_limits(counter_family(
            registry, "axisgate_time_limits_total",
            "Time limits that passed: of a reply, of a probe in a barrier, or of a command in its queue.")),
        outstanding_answers(gauge_family(registry, "axisgate_outstanding_answers",
                                         "Answers to abandoned probes that may still come, and will be dropped.")),
        completions(
            counter_family(registry, "axisgate_completions_total",
                           "Axis numbers that came over the line by themselves: the axis said that it arrived.")),
        motions(counter_family(registry, "axisgate_motions_total", "Motions that ended, by kind and outcome.")),
        stops(counter_family(registry, "axisgate_stops_total",
                             "Stops requested: slowing down (normal, L:) or at once and latched (emergency, L:E).")),
        open_stops(gauge_family(
            registry, "axisgate_open_stops",
            "Stops that nobody has seen the axes obey; late: a caller was notified that the stop stays open.")),
        stop_seconds(prometheus::BuildHistogram()
                         .Name("axisgate_stop_confirmed_seconds")
                         .Help("Time from asking for a stop until its axes were seen stationary.")
                         .Register(registry)),
        emergency_latched(gauge_family(registry, "axisgate_emergency_latched",
                                       "1 from an emergency stop until it is cleared for all axes, else 0.")),
        conditions(
            counter_family(registry, "axisgate_conditions_total",
                           "How often a condition of the stage began, whatever caused it: an emergency stop, a limit "
                           "sensor, an error, a motor that is off, another mode.")),
        positions(gauge_family(registry, "axisgate_position_pulses",
                               "Command counter of an axis in pulses, as last read; NaN when it is not known.")),
        link_up(gauge_family(registry, "axisgate_link_up", "1 when the configured controller answers, else 0.")),
        line_babbles(gauge_family(registry, "axisgate_line_babbles",
                                  "1 while the device sends without end, so that its line is closed, else 0.")),
        barriers(
            counter_family(registry, "axisgate_barriers_total",
                           "How often the gateway matched replies and commands again after a timeout or garbage.")),
        underruns(counter_family(registry, "axisgate_underruns_total",
                                 "Path segments that came after the chain had ended: OK where OK_D was due.")),
        unexpected_lines(counter_family(registry, "axisgate_unexpected_lines_total",
                                        "Lines from the controller that nothing waited for; they are dropped.")) {}

  Family<Counter>& exchanges;
  Family<Histogram>& exchange_seconds;
  Family<Gauge>& queue_depth;
  Family<Histogram>& queue_wait;
  Family<Counter>& line_busy;
  Family<Counter>& line_bytes;
  Family<Counter>& time_limits;
  Family<Gauge>& outstanding_answers;
  Family<Counter>& completions;
  Family<Counter>& motions;
  Family<Counter>& stops;
  Family<Gauge>& open_stops;
  Family<Histogram>& stop_seconds;
  Family<Gauge>& emergency_latched;
  Family<Counter>& conditions;
  Family<Gauge>& positions;
  Family<Gauge>& link_up;
  Family<Gauge>& line_babbles;
  Family<Counter>& barriers;
  Family<Counter>& underruns;
  Family<Counter>& unexpected_lines;
};

StageMetrics::StageMetrics(prometheus::Registry& registry, std::string device, int axis_count)
    : StageMetrics(Families(registry), std::move(device), axis_count) {}

StageMetrics::StageMetrics(const Families& families, std::string device, int axis_count)
    : device_(std::move(device)),
      exchanges_(families.exchanges),
      exchange_seconds_(families.exchange_seconds),
      motions_(families.motions),
      positions_family_(families.positions),
      completions_(static_cast<std::size_t>(axis_count)),
      positions_(static_cast<std::size_t>(axis_count)),
      normal_stops_(families.stops.Add({{"device", device_}, {"kind", "normal"}})),
      emergency_stops_(families.stops.Add({{"device", device_}, {"kind", "emergency"}})),
      open_stops_(families.open_stops.Add({{"device", device_}, {"late", "no"}})),
      late_stops_(families.open_stops.Add({{"device", device_}, {"late", "yes"}})),
      stop_seconds_(families.stop_seconds.Add({{"device", device_}}, kStopSeconds)),
      emergency_latched_(families.emergency_latched.Add({{"device", device_}})),
      link_up_(families.link_up.Add({{"device", device_}})),
      line_babbles_(families.line_babbles.Add({{"device", device_}})),
      barriers_(families.barriers.Add({{"device", device_}})),
      underruns_(families.underruns.Add({{"device", device_}})),
      unexpected_lines_(families.unexpected_lines.Add({{"device", device_}})),
      line_busy_(families.line_busy.Add({{"device", device_}})),
      bytes_in_(families.line_bytes.Add({{"device", device_}, {"direction", "in"}})),
      bytes_out_(families.line_bytes.Add({{"device", device_}, {"direction", "out"}})),
      outstanding_answers_(families.outstanding_answers.Add({{"device", device_}})) {
  using Limit = stage::TimeLimitPassed::Kind;
  for (const Limit kind : {Limit::reply, Limit::probe, Limit::queue}) {
    time_limits_.at(static_cast<std::size_t>(kind)) =
        &families.time_limits.Add({{"device", device_}, {"kind", std::string(stage::name(kind))}});
  }
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
    const prometheus::Labels labels{{"device", device_}, {"lane", std::string(kLaneNames[lane])}};
    lanes_[lane] = &families.queue_depth.Add(labels);
    waits_[lane] = &families.queue_wait.Add(labels, kQueueWaitSeconds);
  }
  for (std::size_t axis = 0; axis < completions_.size(); ++axis) {
    completions_[axis] = &families.completions.Add({{"device", device_}, {"axis", std::to_string(axis + 1)}});
  }
  for (const stage::Condition condition : stage::reported_conditions()) {
    conditions_[condition] = &families.conditions.Add({{"device", device_}, {"condition", stage::name(condition)}});
  }
  // Made now, so that the first motion of each kind counts as an increase.
  using stage::MotionKind, stage::MotionState;
  for (const MotionKind kind : {MotionKind::move, MotionKind::home, MotionKind::return_to_origin, MotionKind::path,
                                MotionKind::execute, MotionKind::jog, MotionKind::scan}) {
    for (const MotionState outcome :
         {MotionState::succeeded, MotionState::stopped, MotionState::failed, MotionState::unknown}) {
      motions(kind, outcome);
    }
  }
}

Counter& StageMetrics::motions(stage::MotionKind kind, stage::MotionState outcome) {
  return motions_.Add(
      {{"device", device_}, {"kind", std::string(stage::name(kind))}, {"outcome", std::string(stage::name(outcome))}});
}

void StageMetrics::on_event(const stage::Event& event) {
  std::visit([this](const auto& what) { count(what); }, event);
}

void StageMetrics::set_state(const stage::State& state) {
  set_link(state.link);
  const auto late = std::ranges::count_if(state.open_stops, [](const stage::Stop& stop) { return stop.late; });
  late_stops_.Set(static_cast<double>(late));
  open_stops_.Set(static_cast<double>(state.open_stops.size()) - static_cast<double>(late));
  emergency_latched_.Set(state.emergency ? 1 : 0);
  for (std::size_t axis = 0; axis < positions_.size(); ++axis) {
    const std::optional<std::int64_t>& position = state.axes[axis].position_pulses;
    if (positions_[axis] == nullptr) {
      if (!position) continue;
      positions_[axis] = &positions_family_.Add({{"device", device_}, {"axis", std::to_string(axis + 1)}});
    }
    // A gauge is a double, which is exact up to 2^53 pulses; the counter has ten digits.
    positions_[axis]->Set(position ? static_cast<double>(*position) : std::numeric_limits<double>::quiet_NaN());
  }
}

void StageMetrics::set_queued(Lane lane, std::size_t commands) {
  lanes_[static_cast<std::size_t>(lane)]->Set(static_cast<double>(commands));
}

void StageMetrics::count(const stage::ExchangeEnded& exchange) {
  CommandSeries& series = commands_[exchange.command];
  Counter*& outcome = series.outcomes[static_cast<std::size_t>(exchange.outcome)];
  if (outcome == nullptr) {
    outcome = &exchanges_.Add({{"device", device_},
                               {"command", std::string(exchange.command)},
                               {"outcome", std::string(stage::name(exchange.outcome))}});
  }
  outcome->Increment();
  if (series.seconds == nullptr) {
    series.seconds =
        &exchange_seconds_.Add({{"device", device_}, {"command", std::string(exchange.command)}}, kExchangeSeconds);
  }
  series.seconds->Observe(seconds(exchange.latency));
  waits_[static_cast<std::size_t>(exchange.lane)]->Observe(seconds(exchange.waited));
  line_busy_.Increment(seconds(exchange.latency));
}

void StageMetrics::count(const stage::MotionChanged& change) {
  // Happens once for each motion, so the family may look its series up.
  if (stage::is_outcome(change.motion.state)) motions(change.motion.kind, change.motion.state).Increment();
}

void StageMetrics::count(const stage::CompletionSeen& completion) {
  completions_.at(static_cast<std::size_t>(completion.axis - 1))->Increment();
}

void StageMetrics::count(const stage::PathProgress& progress) {
  if (progress.step == stage::PathProgress::Step::underrun) underruns_.Increment();
}

void StageMetrics::count(const stage::StopRequested& stop) {
  (stop.emergency ? emergency_stops_ : normal_stops_).Increment();
}

void StageMetrics::count(const stage::StopChanged& change) {
  const stage::Stop& stop = change.stop;
  if (stop.state == stage::StopState::confirmed) stop_seconds_.Observe(seconds(stop.ended - stop.asked));
}

void StageMetrics::count(const stage::ConditionChanged& change) {
  if (change.begun) conditions_.at(change.condition)->Increment();
}

void StageMetrics::count(const stage::LinkChanged& change) { set_link(change.link); }

void StageMetrics::set_link(stage::LinkState link) {
  link_up_.Set(link == stage::LinkState::up ? 1 : 0);
  line_babbles_.Set(link == stage::LinkState::babbling ? 1 : 0);
}

}  // namespace axisgate::server
