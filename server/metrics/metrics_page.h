// The page that Prometheus reads: /metrics over HTTP, on a separate thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/link/asio.h"
#include "device/link/descriptor.h"
#include "server/config/config.h"
#include "server/metrics/page_limits.h"
#include "server/metrics/page_session.h"

namespace axisgate::server {

// Readers cannot block the page for others, whatever their number and speed, even if they never send a complete
// request: when all places are taken, a new connection displaces another.
class MetricsPage {
 public:
  // Called on the page's thread while readers wait.
  using MakeText = std::function<std::string()>;

  // Starts to serve. Fails if it cannot listen at `address`, for instance because the port is in use.
  static Result<std::unique_ptr<MetricsPage>> open(TcpAddress address, MakeText make_text, const PageLimits& limits);
  // Closes all connections.
  ~MetricsPage();
  MetricsPage(const MetricsPage&) = delete;
  MetricsPage& operator=(const MetricsPage&) = delete;

  const TcpAddress& address() const { return address_; }  // with the port actually taken

 private:
  MetricsPage(TcpAddress address, Descriptor listener, MakeText make_text, const PageLimits& limits);
  void wait();
  void accept();
  Descriptor accept_one();
  void accept_later();
  void take_in(Descriptor connection);
  bool displace_one();
  PageText text();

  const TcpAddress address_;
  const MakeText make_text_;
  const PageLimits limits_;
  boost::asio::io_context context_{1};
  boost::asio::posix::stream_descriptor listener_;
  boost::asio::steady_timer pause_;
  std::vector<std::shared_ptr<PageSession>> sessions_;  // includes those that ended since the last connection
  PageText text_;                                       // null before the first request
  TimePoint text_made_{};
  std::thread thread_;
};

}  // namespace axisgate::server
