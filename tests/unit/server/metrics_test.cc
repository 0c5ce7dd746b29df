#include "server/metrics/metrics.h"

#include <gmock/gmock.h>
#include <prometheus/text_serializer.h>

#include <chrono>
#include <map>
#include <set>
#include <string>

#include "server/metrics/stage_metrics.h"

namespace axisgate::server::metrics_test {
namespace {

using stage::ExchangeEnded;
using ::testing::HasSubstr;
using ::testing::Not;

class MetricsTest : public ::testing::Test {
 protected:
  std::string page() const { return prometheus::TextSerializer().Serialize(metrics_.registry()->Collect()); }

  Metrics metrics_;
  StageMetrics device_{*metrics_.registry(), "stage", 3};
};

TEST_F(MetricsTest, ExchangesAreCountedByCommandAndOutcomeWithTheirTime) {
  ExchangeEnded exchange;
  exchange.command = exchange.line = "Q:S";
  exchange.lane = Lane::poll;
  exchange.outcome = ExchangeEnded::Outcome::data;
  exchange.latency = std::chrono::milliseconds(12);
  device_.on_event(exchange);
  device_.on_event(exchange);
  exchange.outcome = ExchangeEnded::Outcome::timed_out;
  device_.on_event(exchange);
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_exchanges_total{command=\"Q:S\",device=\"stage\",outcome=\"data\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_exchanges_total{command=\"Q:S\",device=\"stage\",outcome=\"timed_out\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_exchange_seconds_count{command=\"Q:S\",device=\"stage\"} 3\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_exchange_seconds_bucket{command=\"Q:S\",device=\"stage\",le=\"0.01\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_exchange_seconds_bucket{command=\"Q:S\",device=\"stage\",le=\"0.02\"} 3\n"));
}

TEST_F(MetricsTest, TheLineTellsItsBytesItsTimeAndWhatRanOut) {
  device_.on_event(stage::BytesWritten{"Q:S\r\n", 1, "unix", Lane::poll});
  device_.on_event(stage::BytesReceived{"NG\r\n"});
  device_.on_event(stage::TimeLimitPassed{stage::TimeLimitPassed::Kind::probe});
  ExchangeEnded exchange;
  exchange.command = exchange.line = "Q:S";
  exchange.lane = Lane::poll;
  exchange.latency = std::chrono::milliseconds(250);
  exchange.waited = std::chrono::milliseconds(15);
  device_.on_event(exchange);
  device_.set_outstanding_answers(2);
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_line_bytes_total{device=\"stage\",direction=\"out\"} 5\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_line_bytes_total{device=\"stage\",direction=\"in\"} 4\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_time_limits_total{device=\"stage\",kind=\"probe\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_time_limits_total{device=\"stage\",kind=\"reply\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_line_busy_seconds_total{device=\"stage\"} 0.25\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_queue_wait_seconds_bucket{device=\"stage\",lane=\"poll\",le=\"0.01\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_queue_wait_seconds_bucket{device=\"stage\",lane=\"poll\",le=\"0.02\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_outstanding_answers{device=\"stage\"} 2\n"));
}

TEST_F(MetricsTest, OnlyEndedMotionsCount) {
  stage::Motion motion;
  motion.kind = stage::MotionKind::home;
  motion.state = stage::MotionState::running;
  device_.on_event(stage::MotionChanged{motion});
  EXPECT_THAT(page(), HasSubstr("axisgate_motions_total{device=\"stage\",kind=\"home\",outcome=\"UNKNOWN\"} 0\n"));
  motion.state = stage::MotionState::unknown;
  device_.on_event(stage::MotionChanged{motion});
  EXPECT_THAT(page(), HasSubstr("axisgate_motions_total{device=\"stage\",kind=\"home\",outcome=\"UNKNOWN\"} 1\n"));
}

TEST_F(MetricsTest, CompletionsUnderrunsBarriersStopsAndStrangeLinesAreCounted) {
  device_.on_event(stage::CompletionSeen{3, 0});
  device_.on_event(stage::PathProgress{1, stage::PathProgress::Step::done, 1, ""});
  device_.on_event(stage::PathProgress{1, stage::PathProgress::Step::underrun, 2, "OK"});
  device_.on_event(stage::BarrierEntered{"no reply"});
  device_.on_event(stage::UnexpectedLine{"\x01"});
  device_.on_event(stage::StopRequested{stage::AxisSet::first(3), true, "unix"});
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_completions_total{axis=\"3\",device=\"stage\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_completions_total{axis=\"1\",device=\"stage\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_underruns_total{device=\"stage\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_barriers_total{device=\"stage\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_unexpected_lines_total{device=\"stage\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_stops_total{device=\"stage\",kind=\"emergency\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_stops_total{device=\"stage\",kind=\"normal\"} 0\n"));
}

TEST_F(MetricsTest, ConditionsCountAsTheyBegin) {
  stage::ConditionChanged change{.condition = stage::Condition::emergency_stop, .axes = stage::AxisSet::first(3)};
  EXPECT_THAT(page(), HasSubstr("axisgate_conditions_total{condition=\"emergency_stop\",device=\"stage\"} 0\n"));
  device_.on_event(change);
  change.begun = false;
  device_.on_event(change);
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_conditions_total{condition=\"emergency_stop\",device=\"stage\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_conditions_total{condition=\"motor_off\",device=\"stage\"} 0\n"));
  EXPECT_THAT(text, Not(HasSubstr("origin_sensor")));
}

TEST_F(MetricsTest, StateShowsPositionsTheLinkAndTheQueues) {
  EXPECT_THAT(page(), Not(HasSubstr("axisgate_position_pulses{")));
  stage::State state;
  state.link = stage::LinkState::up;
  state.axis(2).position_pulses = -1000002;
  device_.set_state(state);
  device_.set_queued(Lane::motion, 4);
  std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_position_pulses{axis=\"2\",device=\"stage\"} -1000002\n"));
  EXPECT_THAT(text, Not(HasSubstr("axisgate_position_pulses{axis=\"1\"")));
  EXPECT_THAT(text, HasSubstr("axisgate_link_up{device=\"stage\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_queue_depth{device=\"stage\",lane=\"motion\"} 4\n"));
  state.axis(2).position_pulses.reset();
  state.link = stage::LinkState::doubtful;
  device_.set_state(state);
  text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_position_pulses{axis=\"2\",device=\"stage\"} Nan\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_link_up{device=\"stage\"} 0\n"));
}

using LabelNames = std::set<std::string>;

std::map<std::string, LabelNames> label_names(const std::vector<prometheus::MetricFamily>& families) {
  std::map<std::string, LabelNames> found;
  for (const prometheus::MetricFamily& family : families) {
    for (const prometheus::ClientMetric& metric : family.metric) {
      LabelNames names;
      for (const auto& label : metric.label) names.insert(label.name);
      const auto [known, first] = found.try_emplace(family.name, names);
      EXPECT_EQ(known->second, names) << family.name;
    }
  }
  return found;
}

TEST_F(MetricsTest, EveryFamilyHasItsLabelsAndNoOthers) {
  const std::map<std::string, LabelNames> from_the_start = {
      {"axisgate_barriers_total", {"device"}},
      {"axisgate_build_info", {"compiler", "version"}},
      {"axisgate_completions_total", {"axis", "device"}},
      {"axisgate_conditions_total", {"condition", "device"}},
      {"axisgate_emergency_latched", {"device"}},
      {"axisgate_line_babbles", {"device"}},
      {"axisgate_open_stops", {"device", "late"}},
      {"axisgate_line_busy_seconds_total", {"device"}},
      {"axisgate_line_bytes_total", {"device", "direction"}},
      {"axisgate_link_up", {"device"}},
      {"axisgate_motions_total", {"device", "kind", "outcome"}},
      {"axisgate_outstanding_answers", {"device"}},
      {"axisgate_queue_depth", {"device", "lane"}},
      {"axisgate_queue_wait_seconds", {"device", "lane"}},
      {"axisgate_slow_readers_total", {}},
      {"axisgate_stop_confirmed_seconds", {"device"}},
      {"axisgate_stops_total", {"device", "kind"}},
      {"axisgate_time_limits_total", {"device", "kind"}},
      {"axisgate_underruns_total", {"device"}},
      {"axisgate_unexpected_lines_total", {"device"}},
  };
  EXPECT_EQ(label_names(metrics_.registry()->Collect()), from_the_start);

  ExchangeEnded exchange;
  exchange.command = exchange.line = "Q:S";
  device_.on_event(exchange);
  stage::Motion motion;
  motion.state = stage::MotionState::failed;
  device_.on_event(stage::MotionChanged{motion});
  stage::State state;
  state.axis(1).position_pulses = 0;
  device_.set_state(state);
  std::map<std::string, LabelNames> at_work = from_the_start;
  at_work["axisgate_exchanges_total"] = {"command", "device", "outcome"};
  at_work["axisgate_exchange_seconds"] = {"command", "device"};
  at_work["axisgate_position_pulses"] = {"axis", "device"};
  EXPECT_EQ(label_names(metrics_.registry()->Collect()), at_work);
}

TEST_F(MetricsTest, APortInUseIsAClearError) {
  const Result<int> port = metrics_.expose({"127.0.0.1", 0});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_GT(*port, 0);
  Metrics second;
  const Result<int> refused = second.expose({"127.0.0.1", static_cast<std::uint16_t>(*port)});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("127.0.0.1:" + std::to_string(*port) + ": the port is in use"));
}

}  // namespace
}  // namespace axisgate::server::metrics_test
