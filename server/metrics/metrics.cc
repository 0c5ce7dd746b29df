#include "server/metrics/metrics.h"

#include <fmt/format.h>
#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "server/metrics/families.h"
#include "server/metrics/metrics_page.h"

namespace axisgate::server {

Metrics::Metrics()
    : registry_(std::make_shared<prometheus::Registry>()),
      recorder_drops_(counter_family(*registry_, "axisgate_recorder_dropped_total",
                                     "Recorded lines that a reader of the recording, or its file, was too slow for.")),
      slow_readers_(
          counter_family(*registry_, "axisgate_slow_readers_total",
                         "Times that the reader of a stream fell behind the facts that are kept, and missed some.")
              .Add({})),
      parts_{registry_} {
  gauge_family(*registry_, "axisgate_build_info", "1; the labels say what runs.")
      .Add({{"version", AXISGATE_VERSION}, {"compiler", AXISGATE_COMPILER}})
      .Set(1);
}

Metrics::~Metrics() = default;

Result<int> Metrics::expose(const TcpAddress& address, const PageLimits& limits) {
  auto page = MetricsPage::open(
      address, [this] { return text(); }, limits);
  if (!page) {
    // The page's own problem names the configuration key of another address.
    return fail(Reason::internal,
                fmt::format("cannot serve metrics on {}: the port is in use or not permitted", to_string(address)),
                "stop the program that holds it, or set another address with the key `metrics` in the configuration");
  }
  page_ = *std::move(page);
  return page_->address().port;
}

void Metrics::add(std::shared_ptr<prometheus::Collectable> part) {
  const std::lock_guard lock(parts_mutex_);
  parts_.push_back(std::move(part));
}

std::string Metrics::text() {
  // Collecting may take long and must not delay a thread that calls add(), so the lock covers only the copy.
  const auto parts = [this] {
    const std::lock_guard lock(parts_mutex_);
    return parts_;
  }();
  std::vector<prometheus::MetricFamily> families;
  for (const auto& part : parts) std::ranges::move(part->Collect(), std::back_inserter(families));
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace axisgate::server
