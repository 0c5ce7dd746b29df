// Expiry time of the daemon's certificate on the metrics page.
#pragma once

#include <prometheus/collectable.h>

#include <string>
#include <vector>

namespace axisgate::server {

// Reads the file for each request of the page, so that a new certificate appears without a restart.
class CertificateMetrics final : public prometheus::Collectable {
 public:
  explicit CertificateMetrics(std::string certificate) : certificate_(std::move(certificate)) {}

  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  const std::string certificate_;
};

}  // namespace axisgate::server
