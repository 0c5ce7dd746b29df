#include "server/metrics/connection_metrics.h"

#include <prometheus/metric_family.h>

#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace axisgate::server {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

ClientMetric open_of_kind(const char* kind, std::size_t connections) {
  ClientMetric metric;
  metric.label = {{"kind", kind}};
  metric.gauge.value = static_cast<double>(connections);
  return metric;
}

MetricFamily counter(const char* name, const char* help, std::uint64_t count) {
  ClientMetric metric;
  metric.counter.value = static_cast<double>(count);
  return {name, help, MetricType::Counter, {metric}};
}

}  // namespace

class ConnectionMetrics::Part final : public prometheus::Collectable {
 public:
  explicit Part(std::function<ConnectionCounts()> ask) : ask_(std::move(ask)) {}

  void end() {
    const std::lock_guard lock(mutex_);
    ask_ = nullptr;
  }

  std::vector<MetricFamily> Collect() const override {
    const std::lock_guard lock(mutex_);
    if (!ask_) return {};
    const ConnectionCounts counts = ask_();
    return {{"axisgate_connections",
             "Client connections that are open: ordinary ones (open), and those that are served a stop only (reserve).",
             MetricType::Gauge,
             {open_of_kind("open", counts.open), open_of_kind("reserve", counts.in_reserve)}},
            counter("axisgate_connections_refused_total", "Connections beyond the limit: they could only stop.",
                    counts.reserved),
            counter("axisgate_descriptors_exhausted_total",
                    "Times that a connection found no descriptor free in the daemon.", counts.out_of_descriptors)};
  }

 private:
  mutable std::mutex mutex_;
  std::function<ConnectionCounts()> ask_;
};

ConnectionMetrics::ConnectionMetrics(Metrics& metrics, std::function<ConnectionCounts()> ask)
    : part_(std::make_shared<Part>(std::move(ask))) {
  metrics.add(part_);
}

ConnectionMetrics::~ConnectionMetrics() { part_->end(); }

}  // namespace axisgate::server
