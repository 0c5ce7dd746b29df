#include "server/connection_metrics.h"

#include <gmock/gmock.h>

#include <optional>
#include <string>

#include "tests/unit/metrics_page.h"

namespace axisgate::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ConnectionMetrics, AreAskedForAsThePageIsAndOnlyWhileTheyLive) {
  Metrics metrics;
  const Result<int> port = metrics.expose({"127.0.0.1", 0});
  ASSERT_TRUE(port) << port.error().message;
  ConnectionCounts counts;
  std::optional<ConnectionMetrics> connections;
  connections.emplace(metrics, [&counts] { return counts; });
  EXPECT_THAT(metrics_page(*port), HasSubstr("axisgate_connections_refused_total 0\n"));
  counts.open = 3;
  counts.in_reserve = 2;
  counts.reserved = 7;
  counts.out_of_descriptors = 5;
  const std::string page = metrics_page(*port);
  EXPECT_THAT(page, HasSubstr("axisgate_connections{kind=\"open\"} 3\n"));
  EXPECT_THAT(page, HasSubstr("axisgate_connections{kind=\"reserve\"} 2\n"));
  EXPECT_THAT(page, HasSubstr("axisgate_connections_refused_total 7\n"));
  EXPECT_THAT(page, HasSubstr("axisgate_descriptors_exhausted_total 5\n"));
  connections.reset();
  EXPECT_THAT(metrics_page(*port), Not(HasSubstr("axisgate_connections")));
}

TEST(ConnectionMetrics, MayComeBeforeThePage) {
  Metrics metrics;
  const ConnectionMetrics connections(metrics, [] { return ConnectionCounts{}; });
  const Result<int> port = metrics.expose({"127.0.0.1", 0});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_THAT(metrics_page(*port), HasSubstr("axisgate_connections{kind=\"open\"} 0\n"));
}

}  // namespace
}  // namespace axisgate::server
