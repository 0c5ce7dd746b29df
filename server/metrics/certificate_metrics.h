// Until when the daemon's certificate is good, on the metrics page.
#pragma once

#include <prometheus/collectable.h>

#include <string>
#include <vector>

namespace axisgate::server {

// Reads the file whenever the page is requested, so that a new certificate shows without a restart.
class CertificateMetrics final : public prometheus::Collectable {
 public:
  explicit CertificateMetrics(std::string certificate) : certificate_(std::move(certificate)) {}

  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  const std::string certificate_;
};

}  // namespace axisgate::server
