#include "server/metrics/journal_metrics.h"

#include <prometheus/metric_family.h>

#include <chrono>
#include <string>

namespace axisgate::server {
namespace {

prometheus::MetricFamily gauge(std::string name, std::string help, double value) {
  prometheus::ClientMetric metric;
  metric.gauge.value = value;
  return {std::move(name), std::move(help), prometheus::MetricType::Gauge, {metric}};
}

}  // namespace

std::vector<prometheus::MetricFamily> JournalMetrics::Collect() const {
  const std::chrono::duration<double> commit = journal_.last_commit();
  return {
      gauge("axisgate_journal_available",
            "1 if the disk takes the journal; 0 if it refuses it or hangs, or the journal could not be opened, so that "
            "motions and changes are refused.",
            journal_.failure() ? 0 : 1),
      gauge("axisgate_journal_commit_seconds",
            "How long the newest commit to the journal took, which each motion waits for; for a commit in progress, "
            "its time up to now.",
            commit.count())};
}

}  // namespace axisgate::server
