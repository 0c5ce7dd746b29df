// State of the journal on the metrics page.
#pragma once

#include <prometheus/collectable.h>

#include <vector>

#include "server/journal/journal.h"

namespace axisgate::server {

class JournalMetrics final : public prometheus::Collectable {
 public:
  // `journal` must outlive this object.
  explicit JournalMetrics(const journal::Journal& journal) : journal_(journal) {}

  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  const journal::Journal& journal_;
};

}  // namespace axisgate::server
