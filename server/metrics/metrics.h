// Metrics for Prometheus: fixed names and label sets, one time series per device and table entry. This file has the
// page and the metrics that belong to no kind of device.
#pragma once

#include <prometheus/collectable.h>
#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/registry.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "server/config/config.h"
#include "server/metrics/page_limits.h"

namespace axisgate::server {

class MetricsPage;

// The daemon has one Metrics. Thread safe after construction, except for expose() and add(), which one thread must
// call.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  // Serves /metrics at the address and returns the port. Fails if the port is in use. Call it once.
  Result<int> expose(const TcpAddress& address, const PageLimits& limits = {});

  // Adds a source of metrics that is queried for each request of the page. It is kept as long as the page, so that the
  // page's thread never destroys it.
  void add(std::shared_ptr<prometheus::Collectable> part);

  const std::shared_ptr<prometheus::Registry>& registry() const { return registry_; }

  prometheus::Counter& slow_readers() { return slow_readers_; }
  // Returns the counter of a device's lost recording lines. Any thread may count.
  prometheus::Counter& recorder_drops(const std::string& device) { return recorder_drops_.Add({{"device", device}}); }

 private:
  std::string text();

  std::shared_ptr<prometheus::Registry> registry_;
  prometheus::Family<prometheus::Counter>& recorder_drops_;
  prometheus::Counter& slow_readers_;
  std::mutex parts_mutex_;
  std::vector<std::shared_ptr<prometheus::Collectable>> parts_;
  std::unique_ptr<MetricsPage> page_;  // last, because its thread uses the other members
};

}  // namespace axisgate::server
