#include "tests/bench/minimal_line.h"

#include <stdexcept>
#include <utility>

#include "device/link/serial_port.h"

namespace axisgate::bench {
namespace {

int open_or_throw(const std::string& path) {
  const auto tty = open_serial({.path = path, .flow = FlowControl::none});
  if (!tty) throw std::runtime_error(tty.error().message);
  return *tty;
}

}  // namespace

MinimalLine::MinimalLine(const std::string& tty)
    : work_(context_.get_executor()), tty_(context_, open_or_throw(tty)), thread_([this] { context_.run(); }) {}

MinimalLine::~MinimalLine() {
  context_.stop();
  thread_.join();
}

void MinimalLine::ask(std::string line, OnReply on_reply) {
  boost::asio::post(context_, [this, line = std::move(line), on_reply = std::move(on_reply)]() mutable {
    exchanges_.push_back({std::move(line) + "\r\n", std::move(on_reply)});
    if (exchanges_.size() == 1) send_next();
  });
}

void MinimalLine::send_next() {
  if (exchanges_.empty()) return;
  boost::asio::async_write(tty_, boost::asio::buffer(exchanges_.front().line),
                           [this](const boost::system::error_code& error, std::size_t) {
                             if (!error) read();
                           });
}

void MinimalLine::read() {
  tty_.async_read_some(boost::asio::buffer(buffer_), [this](const boost::system::error_code& error, std::size_t size) {
    if (!error) take(size);
  });
}

void MinimalLine::take(std::size_t size) {
  received_.append(buffer_.data(), size);
  const auto end = received_.find("\r\n");
  if (end == std::string::npos) return read();
  const std::string reply = received_.substr(0, end);
  received_.erase(0, end + 2);
  const OnReply on_reply = std::move(exchanges_.front().on_reply);
  exchanges_.pop_front();
  on_reply(reply);
  send_next();
}

}  // namespace axisgate::bench
