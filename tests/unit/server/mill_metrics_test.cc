// Values of mills on the metrics page.
#include "server/metrics/mill_metrics.h"

#include <gmock/gmock.h>
#include <prometheus/text_serializer.h>

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "server/metrics/metrics.h"

namespace axisgate::server::mill_metrics_test {
namespace {

using jobs::Job;
using jobs::JobState;
using std::chrono_literals::operator""s;
using ::testing::HasSubstr;
using ::testing::Not;

class MillMetricsTest : public ::testing::Test {
 protected:
  std::string page() const { return prometheus::TextSerializer().Serialize(metrics_.registry()->Collect()); }

  static Job job(JobState state) {
    Job one;
    one.parts = {{"T1", 100, {20s, 30s}}};
    one.state = state;
    return one;
  }

  // Changes the job to `state` at the time `at`.
  void change(JobState state, std::chrono::seconds at) { mill_.count(job(state), TimePoint(at)); }

  Metrics metrics_;
  MillMetrics mill_{*metrics_.registry(), "mill"};
};

TEST_F(MillMetricsTest, JobsAreCountedByWhatBecameOfThem) {
  EXPECT_THAT(page(), HasSubstr("axisgate_mill_jobs_total{device=\"mill\",outcome=\"ABORTED\"} 0\n"));
  for (const JobState state : {JobState::queued, JobState::confirmed, JobState::running, JobState::aborted}) {
    change(state, 0s);
  }
  change(JobState::running, 0s);
  change(JobState::fed, 1s);
  change(JobState::done, 2s);
  change(JobState::paused_unknown, 3s);
  change(JobState::cancelled, 4s);
  change(JobState::expired, 5s);
  const std::string text = page();
  for (const char* outcome : {"ABORTED", "FED", "DONE", "PAUSED_UNKNOWN", "CANCELLED", "EXPIRED"}) {
    EXPECT_THAT(text,
                HasSubstr(std::string("axisgate_mill_jobs_total{device=\"mill\",outcome=\"") + outcome + "\"} 1\n"));
  }
  EXPECT_THAT(text, Not(HasSubstr("outcome=\"QUEUED\"")));
  EXPECT_THAT(text, Not(HasSubstr("outcome=\"RUNNING\"")));
}

// Only jobs that became FED count: an abort says nothing about the estimate.
TEST_F(MillMetricsTest, TheTimeOfAJobBesideItsEstimate) {
  change(JobState::running, 100s);
  change(JobState::aborted, 107s);
  EXPECT_THAT(page(), HasSubstr("axisgate_mill_job_seconds_total{device=\"mill\"} 0\n"));
  for (int i = 0; i < 2; ++i) {
    change(JobState::running, 200s);
    change(JobState::fed, 233s);
    change(JobState::done, 900s);
  }
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_mill_job_seconds_total{device=\"mill\"} 66\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_job_estimate_seconds_total{bound=\"least\",device=\"mill\"} 40\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_job_estimate_seconds_total{bound=\"most\",device=\"mill\"} 60\n"));
}

TEST_F(MillMetricsTest, BytesAndCommandsOfEachJob) {
  change(JobState::running, 0s);
  mill_.count_written(0);  // bytes written before the job
  mill_.count_written(6);
  mill_.count_written(20);
  mill_.count_written(20);  // bytes written after the job
  change(JobState::running, 9s);
  mill_.count_written(6);
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_mill_written_bytes_total{device=\"mill\"} 26\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_commands_total{device=\"mill\"} 3\n"));
}

TEST_F(MillMetricsTest, TheBufferIsARangeWhileAJobRuns) {
  jobs::RunningJob running;
  running.progress = {.written = 100, .unsent = 0, .executed_least = 30, .executed_most = 80};
  running.busy = true;
  mill_.set_state({}, running);
  std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_mill_buffer_bytes{bound=\"least\",device=\"mill\"} 20\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_buffer_bytes{bound=\"most\",device=\"mill\"} 70\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_busy{device=\"mill\"} 1\n"));
  mill_.set_state({}, std::nullopt);
  text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_mill_buffer_bytes{bound=\"least\",device=\"mill\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_buffer_bytes{bound=\"most\",device=\"mill\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_busy{device=\"mill\"} 0\n"));
}

TEST_F(MillMetricsTest, TheMeasuredPaceIsARange) {
  EXPECT_THAT(page(), HasSubstr("axisgate_mill_pace_ratio{bound=\"most\",device=\"mill\"} 0\n"));
  mill_.set_pace(jobs::MeasuredPace{1.125, 1.25});
  EXPECT_THAT(page(), HasSubstr("axisgate_mill_pace_ratio{bound=\"least\",device=\"mill\"} 1.125\n"));
  EXPECT_THAT(page(), HasSubstr("axisgate_mill_pace_ratio{bound=\"most\",device=\"mill\"} 1.25\n"));
}

TEST_F(MillMetricsTest, TheQueueByState) {
  mill_.set_state({job(JobState::fed), job(JobState::queued), job(JobState::queued)}, std::nullopt);
  std::string text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_mill_queued_jobs{device=\"mill\",state=\"QUEUED\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_queued_jobs{device=\"mill\",state=\"FED\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_queued_jobs{device=\"mill\",state=\"PAUSED_UNKNOWN\"} 0\n"));
  mill_.set_state({}, std::nullopt);
  text = page();
  EXPECT_THAT(text, HasSubstr("axisgate_mill_queued_jobs{device=\"mill\",state=\"FED\"} 0\n"));
}

TEST_F(MillMetricsTest, TheLineAndTheAborts) {
  mill_.set_link(jobs::MachineLink::open);
  mill_.count_abort();
  EXPECT_THAT(page(), HasSubstr("axisgate_mill_line_open{device=\"mill\"} 1\n"));
  EXPECT_THAT(page(), HasSubstr("axisgate_mill_aborts_total{device=\"mill\"} 1\n"));
  mill_.set_link(jobs::MachineLink::closed);
  EXPECT_THAT(page(), HasSubstr("axisgate_mill_line_open{device=\"mill\"} 0\n"));
}

TEST_F(MillMetricsTest, NothingOfAStageIsShown) {
  std::map<std::string, std::set<std::string>> labels;
  for (const auto& family : metrics_.registry()->Collect()) {
    for (const auto& label : family.metric.at(0).label) labels[family.name].insert(label.name);
  }
  labels.erase("axisgate_build_info");
  const std::map<std::string, std::set<std::string>> expected = {
      {"axisgate_mill_aborts_total", {"device"}},
      {"axisgate_mill_buffer_bytes", {"bound", "device"}},
      {"axisgate_mill_busy", {"device"}},
      {"axisgate_mill_commands_total", {"device"}},
      {"axisgate_mill_job_estimate_seconds_total", {"bound", "device"}},
      {"axisgate_mill_job_seconds_total", {"device"}},
      {"axisgate_mill_jobs_total", {"device", "outcome"}},
      {"axisgate_mill_line_open", {"device"}},
      {"axisgate_mill_pace_ratio", {"bound", "device"}},
      {"axisgate_mill_queued_jobs", {"device", "state"}},
      {"axisgate_mill_written_bytes_total", {"device"}},
  };
  EXPECT_EQ(labels, expected);
}

TEST(MillMetrics, TwoMillsShareTheFamilies) {
  Metrics metrics;
  MillMetrics one(*metrics.registry(), "one");
  MillMetrics other(*metrics.registry(), "other");
  one.count_abort();
  const std::string text = prometheus::TextSerializer().Serialize(metrics.registry()->Collect());
  EXPECT_THAT(text, HasSubstr("axisgate_mill_aborts_total{device=\"one\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("axisgate_mill_aborts_total{device=\"other\"} 0\n"));
}

}  // namespace
}  // namespace axisgate::server::mill_metrics_test
