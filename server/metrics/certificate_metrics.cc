#include "server/metrics/certificate_metrics.h"

#include <prometheus/metric_family.h>

#include <chrono>

#include "server/connections/certificates.h"

namespace axisgate::server {

std::vector<prometheus::MetricFamily> CertificateMetrics::Collect() const {
  const Result<WallTime> until = expiry(certificate_);
  prometheus::ClientMetric metric;
  // 0: the file cannot be read, for any reason.
  metric.gauge.value = until ? std::chrono::duration<double>(until->time_since_epoch()).count() : 0;
  return {{"axisgate_certificate_expiry_timestamp_seconds",
           "When the certificate expires that is served on the network; 0 where its file cannot be read.",
           prometheus::MetricType::Gauge,
           {metric}}};
}

}  // namespace axisgate::server
