#include "server/front/connection.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <utility>

#include "server/limits.h"

namespace axisgate::front {
namespace {

namespace asio = boost::asio;

// Bytes that are decided in one go. They contain a few dozen calls, which delay a stop of others by about a
// millisecond.
constexpr std::size_t kPortion = 1024;

// A waiting connection keeps no buffer, because there may be thousands of them.
void free(std::string& buffer) { std::string().swap(buffer); }

}  // namespace

Connection::Connection(const Surroundings& around, Peer peer, bool stops_only)
    : around_(around),
      peer_(std::move(peer)),
      stops_only_(stops_only),
      grpc_(around.strand),
      budget_timer_(around.strand) {}

void Connection::start(std::unique_ptr<Wire> wire) {
  wire_ = std::move(wire);
  begin();
}

void Connection::handshake_over(std::optional<std::string> certificate) {
  if (certificate) {
    peer_.who = *std::move(certificate);
    peer_.needs_token = false;
  }
  begin();
}

void Connection::begin() {
  // An answer may come from any thread, and after the connection has gone.
  auto on_answer = [self = weak_from_this(), inbox = around_.inbox](StreamId stream) {
    inbox->post([self, stream] {
      if (const auto connection = self.lock()) connection->pull(stream);
    });
  };
  conversation_.emplace(around_.shared, peer_, stops_only_, std::move(on_answer), monotonic_now());
  move_on();
}

void Connection::announce_end() {
  if (closed_ || !conversation_) return;
  conversation_->announce_end();
  move_on();
}

void Connection::pull(StreamId stream) {
  if (closed_) return;
  conversation_->pull(stream);
  move_on();
}

// Starts every operation that can start now.
void Connection::move_on() {
  if (closed_) return;
  if (conversation_->uses_grpc() && !grpc_.is_open()) connect_to_grpc();
  write_client();
  write_grpc();
  if (conversation_->over()) {
    if (!writes_client_ && !conversation_->has_for_client()) return close();
    if (!over_since_) over_since_ = monotonic_now();
    return;
  }
  read_client();
  read_grpc();
}

void Connection::read_client() {
  if (reads_client_ || closed_) return;
  if (!unfed_.empty()) return feed_later();
  if (conversation_->full()) return;
  const TimePoint now = monotonic_now();
  if (conversation_->not_before() > now) return wait_for_budget(now);
  reads_client_ = true;
  wire_->read_some([this, self = shared_from_this()](const Error& error, std::string bytes) {
    reads_client_ = false;
    if (error) return close();
    active_ = monotonic_now();
    from_client_ = std::move(bytes);
    unfed_ = from_client_;
    feed();
  });
}

// Bytes that come at once are decided in portions, so that other connections get their turn in between. All bytes that
// were read are decided, whatever the budget: a client whose debt becomes long this way must be closed.
void Connection::feed_later() {
  reads_client_ = true;
  asio::post(around_.strand, [this, self = shared_from_this()] {
    reads_client_ = false;
    if (!closed_) feed();
  });
}

void Connection::feed() {
  const std::string_view portion = unfed_.substr(0, kPortion);
  unfed_.remove_prefix(portion.size());
  conversation_->from_client(portion, monotonic_now());
  if (unfed_.empty()) free(from_client_);
  move_on();
}

void Connection::wait_for_budget(TimePoint now) {
  reads_client_ = true;
  budget_timer_.expires_after(conversation_->not_before() - now);
  budget_timer_.async_wait([this, self = shared_from_this()](const Error&) {
    reads_client_ = false;
    if (!closed_) move_on();
  });
}

void Connection::write_client() {
  if (writes_client_ || !conversation_->has_for_client()) return;
  to_client_ = conversation_->take_to_client();
  if (to_client_.empty()) return;
  writes_client_ = true;
  wire_->write(asio::buffer(to_client_), [this, self = shared_from_this()](const Error& error) {
    writes_client_ = false;
    if (error) return close();
    free(to_client_);
    move_on();
  });
}

void Connection::connect_to_grpc() {
  Error error;
  asio::local::stream_protocol::socket theirs(around_.strand);
  asio::local::connect_pair(grpc_, theirs, error);
  if (error) {
    grpc_.close(error);
    return conversation_->grpc_failed();
  }
  grpc_.non_blocking(true, error);
  theirs.non_blocking(true, error);
  const int descriptor = theirs.release(error);
  around_.to_grpc(Descriptor(descriptor));
}

void Connection::read_grpc() {
  if (reads_grpc_ || closed_ || grpc_left_ || !grpc_.is_open()) return;
  reads_grpc_ = true;
  grpc_.async_wait(asio::socket_base::wait_read, [this, self = shared_from_this()](const Error& error) {
    reads_grpc_ = false;
    if (closed_) return;
    if (!error) take_from_grpc();
    move_on();
  });
}

void Connection::take_from_grpc() {
  std::array<char, 16 * 1024> bytes;
  Error error;
  const std::size_t size = grpc_.read_some(asio::buffer(bytes), error);
  if (error == asio::error::would_block) return;
  if (!error) return conversation_->from_grpc({bytes.data(), size});
  grpc_left_ = true;
  over_since_ = monotonic_now();  // so that a client that does not take the rest is closed after server::kFarewell
  conversation_->grpc_left();
}

void Connection::write_grpc() {
  if (writes_grpc_ || closed_ || !conversation_->has_for_grpc()) return;
  to_grpc_ = conversation_->take_to_grpc();
  if (to_grpc_.empty()) return;
  writes_grpc_ = true;
  asio::async_write(grpc_, asio::buffer(to_grpc_), [this, self = shared_from_this()](const Error& error, std::size_t) {
    if (error) return;  // gRPC has closed its end: its earlier bytes are still read, but no more are written
    writes_grpc_ = false;
    free(to_grpc_);
    move_on();
  });
}

void Connection::check(TimePoint now) {
  const FrontLimits& limits = around_.shared.limits;
  if (over_since_ && now - *over_since_ > server::kFarewell) return close();
  if (now - begun_ > limits.silence) {
    if (!conversation_) return close(Closing{Cause::handshake_failed, "the TLS handshake was not finished in time"});
    if (!conversation_->admitted()) return close(Closing{Cause::no_call, "no call came in time"});
  }
  if (!conversation_) return;
  const bool reads = !conversation_->full() && conversation_->not_before() <= now;
  conversation_->check(now, reads);
  move_on();
  if (closed_ || !conversation_->stops_only() || conversation_->calls() > 0) return;
  if (now - active_ > limits.reserve_idle || now - begun_ > limits.reserve_age) close();
}

void Connection::close(const std::optional<Closing>& why) {
  if (std::exchange(closed_, true)) return;
  const auto self = shared_from_this();
  Error ignored;
  wire_->close();
  grpc_.close(ignored);
  budget_timer_.cancel();
  const bool at_fault = conversation_ && conversation_->fault();
  around_.ended(*this, at_fault ? conversation_->fault() : why);
}

}  // namespace axisgate::front
