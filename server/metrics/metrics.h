// What Prometheus may know: fixed names, fixed label sets, one time series per device and table entry. Here: the page,
// and what belongs to no kind of device.
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

// One for the daemon. Thread safe once constructed, but for expose() and add(), which are one thread's.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  // Serves /metrics at the address and returns the port taken, or says why not (a port in use). Call it once.
  Result<int> expose(const TcpAddress& address, const PageLimits& limits = {});

  // Stands on the page, too: for what is not counted but asked when the page is. Kept as long as the page, so that
  // the page's thread is not the last to hold it.
  void add(std::shared_ptr<prometheus::Collectable> part);

  const std::shared_ptr<prometheus::Registry>& registry() const { return registry_; }

  prometheus::Counter& slow_readers() { return slow_readers_; }
  // Recorded lines of a device that were lost. Any thread may count.
  prometheus::Counter& recorder_drops(const std::string& device) { return recorder_drops_.Add({{"device", device}}); }

 private:
  std::string text();

  std::shared_ptr<prometheus::Registry> registry_;
  prometheus::Family<prometheus::Counter>& recorder_drops_;
  prometheus::Counter& slow_readers_;
  std::mutex parts_mutex_;
  std::vector<std::shared_ptr<prometheus::Collectable>> parts_;
  std::unique_ptr<MetricsPage> page_;  // last: its thread uses the others
};

}  // namespace axisgate::server
