// The connections on the metrics page. They are counted for each request, since gRPC closes them without a report.
#pragma once

#include <functional>
#include <memory>

#include "server/connections/acceptor.h"
#include "server/metrics/metrics.h"

namespace axisgate::server {

class ConnectionMetrics {
 public:
  // `ask` is called on the page's thread as long as this object lives.
  ConnectionMetrics(Metrics& metrics, std::function<ConnectionCounts()> ask);
  // Waits for a page that is being made.
  ~ConnectionMetrics();
  ConnectionMetrics(const ConnectionMetrics&) = delete;
  ConnectionMetrics& operator=(const ConnectionMetrics&) = delete;

 private:
  class Part;

  const std::shared_ptr<Part> part_;
};

}  // namespace axisgate::server
