#include "server/metrics/metrics_page.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "device/link/clock.h"
#include "server/connections/acceptor.h"
#include "server/connections/endpoints.h"

namespace axisgate::server {

Result<std::unique_ptr<MetricsPage>> MetricsPage::open(TcpAddress address, MakeText make_text,
                                                       const PageLimits& limits) {
  Result<Descriptor> listener = listen_on(address);
  if (!listener) return tl::unexpected(listener.error());
  return std::unique_ptr<MetricsPage>(
      new MetricsPage(std::move(address), *std::move(listener), std::move(make_text), limits));
}

MetricsPage::MetricsPage(TcpAddress address, Descriptor listener, MakeText make_text, const PageLimits& limits)
    : address_(std::move(address)),
      make_text_(std::move(make_text)),
      limits_(limits),
      listener_(context_, listener.release()),
      pause_(context_) {
  wait();
  thread_ = std::thread([this] { context_.run(); });
}

MetricsPage::~MetricsPage() {
  context_.stop();
  thread_.join();
}

void MetricsPage::wait() {
  listener_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [this](const boost::system::error_code&) { accept(); });
}

void MetricsPage::accept() {
  Descriptor connection = accept_one();
  if (!connection.valid()) return accept_later();
  take_in(std::move(connection));
  wait();
}

// Closes another connection if no descriptor is free.
Descriptor MetricsPage::accept_one() {
  Descriptor connection(Acceptor::accept_connection(listener_.native_handle()));
  const bool out_of_descriptors = !connection.valid() && (errno == EMFILE || errno == ENFILE);
  if (out_of_descriptors && displace_one()) {
    connection = Descriptor(Acceptor::accept_connection(listener_.native_handle()));
  }
  return connection;
}

void MetricsPage::accept_later() {
  pause_.expires_after(limits_.accept_pause);
  pause_.async_wait([this](const boost::system::error_code&) { accept(); });
}

void MetricsPage::take_in(Descriptor connection) {
  std::erase_if(sessions_, [](const auto& session) { return !session->is_open(); });
  if (sessions_.size() >= limits_.connections) displace_one();
  sessions_.push_back(PageSession::start(context_, std::move(connection), limits_, [this] { return text(); }));
}

// Ends the connection that has waited longest without a complete request. If all have one, ends the slowest reader,
// since others receive their answer within milliseconds. Returns false without a connection to end.
bool MetricsPage::displace_one() {
  std::erase_if(sessions_, [](const auto& session) { return !session->is_open(); });
  const auto oldest = std::ranges::min_element(
      sessions_, {}, [](const auto& session) { return std::pair(session->is_answering(), session->since()); });
  if (oldest == sessions_.end()) return false;
  (*oldest)->end();
  sessions_.erase(oldest);
  return true;
}

PageText MetricsPage::text() {
  if (text_ == nullptr || monotonic_now() - text_made_ >= limits_.text_age) {
    text_ = std::make_shared<const std::string>(make_text_());
    text_made_ = monotonic_now();
  }
  return text_;
}

}  // namespace axisgate::server
