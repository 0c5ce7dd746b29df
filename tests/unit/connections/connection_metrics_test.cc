#include "server/metrics/connection_metrics.h"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <string>

#include "tests/unit/server/metrics_page.h"

namespace axisgate::server::connection_metrics_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ConnectionMetrics, AreAskedForAsThePageIsAndOnlyWhileTheyLive) {
  Metrics metrics;
  const Result<int> port = metrics.expose({"127.0.0.1", 0}, {.text_age = {}});
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

TEST(ConnectionMetrics, WhoeverEndsThemWaitsForAPageThatIsBeingMade) {
  Metrics metrics;
  const Result<int> port = metrics.expose({"127.0.0.1", 0});
  ASSERT_TRUE(port) << port.error().message;
  std::promise<void> asked, answer;
  std::atomic<bool> answered = false;
  std::optional<ConnectionMetrics> connections;
  connections.emplace(metrics, [&] {
    asked.set_value();
    answer.get_future().wait();
    answered = true;
    return ConnectionCounts{};
  });
  const auto page = std::async(std::launch::async, [&] { return metrics_page(*port); });
  asked.get_future().wait();
  auto ended = std::async(std::launch::async, [&] {
    connections.reset();
    return answered.load();
  });
  // No event shows that the other thread waits; without the wait it would finish well within this time.
  EXPECT_EQ(ended.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  answer.set_value();
  EXPECT_TRUE(ended.get());
}

TEST(ConnectionMetrics, MayComeBeforeThePage) {
  Metrics metrics;
  const ConnectionMetrics connections(metrics, [] { return ConnectionCounts{}; });
  const Result<int> port = metrics.expose({"127.0.0.1", 0});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_THAT(metrics_page(*port), HasSubstr("axisgate_connections{kind=\"open\"} 0\n"));
}

}  // namespace
}  // namespace axisgate::server::connection_metrics_test
