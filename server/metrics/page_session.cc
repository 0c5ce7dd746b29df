#include "server/metrics/page_session.h"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "device/link/clock.h"

namespace axisgate::server {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;

using boost::system::error_code;
using Stream = beast::basic_stream<boost::asio::ip::tcp, boost::asio::io_context::executor_type>;
using Parser = http::request_parser<http::empty_body>;
using Answer = http::response<http::span_body<const char>>;

// The format that prometheus::TextSerializer writes.
constexpr std::string_view kPageType = "text/plain; version=0.0.4; charset=utf-8";
constexpr std::string_view kSentenceType = "text/plain; charset=utf-8";

// Bytes that one read takes of an idle or leaving connection.
constexpr std::size_t kReadAhead = 4096;

beast::string_view to_beast(std::string_view text) { return {text.data(), text.size()}; }

bool is_too_long(const error_code& error) {
  return error == http::error::header_limit || error == http::error::buffer_overflow;
}

// A reader that ends in the middle of a request is not answered.
bool is_malformed(const error_code& error) {
  return error.category() == http::make_error_code(http::error::bad_method).category() &&
         error != http::error::end_of_stream && error != http::error::partial_message;
}

class BeastSession final : public PageSession, public std::enable_shared_from_this<BeastSession> {
 public:
  BeastSession(Stream::socket_type socket, const PageLimits& limits, TakePageText take_text)
      : limits_(limits),
        take_text_(std::move(take_text)),
        stream_(std::move(socket)),
        received_(limits.head_bytes + kReadAhead) {}

  void start() { ask(); }

  void end() override {
    error_code ignored;
    stream_.socket().close(ignored);
    text_ = nullptr;
  }

  bool is_open() const override { return stream_.socket().is_open(); }
  bool is_answering() const override { return state_ == State::answering; }
  TimePoint since() const override { return since_; }

 private:
  enum class State { asking, answering, idle, leaving };

  void enter(State state, Duration limit) {
    state_ = state;
    since_ = monotonic_now();
    stream_.expires_after(limit);
  }

  // Reads the head of a request.
  void ask() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(limits_.head_bytes));
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // no body is read
    enter(State::asking, limits_.head);
    read_head();
  }

  void read_head() {
    http::async_read_header(
        stream_, received_, *parser_,
        [self = shared_from_this()](const error_code& error, std::size_t) { self->take_head(error); });
  }

  // A time limit that has passed closes the stream.
  void take_head(const error_code& error) {
    if (!is_open()) return end();
    if (is_too_long(error)) {
      return refuse(http::status::request_header_fields_too_large, "The head of the request is too long.\n");
    }
    if (is_malformed(error)) {
      return refuse(http::status::bad_request, "This is not a request of HTTP/1.0 or HTTP/1.1.\n");
    }
    if (error) return end();
    // A body is not read, and would look like the next request.
    const bool has_body =
        parser_->get().count(http::field::transfer_encoding) > 0 || parser_->content_length().value_or(0) > 0;
    keeps_alive_ = parser_->get().keep_alive() && !has_body;
    answer();
  }

  void answer() {
    const Parser::value_type& request = parser_->get();
    const beast::string_view target = request.target();
    if (target.substr(0, target.find('?')) != "/metrics") {
      return say(http::status::not_found, "Only /metrics is here: the metrics of axisgated.\n");
    }
    if (request.method() == http::verb::get || request.method() == http::verb::head) {
      return send(http::status::ok, kPageType, take_text_());
    }
    answer_.set(http::field::allow, "GET, HEAD");
    say(http::status::method_not_allowed, "This page can only be read: use GET.\n");
  }

  void refuse(http::status status, std::string sentence) {
    keeps_alive_ = false;
    say(status, std::move(sentence));
  }

  void say(http::status status, std::string sentence) {
    send(status, kSentenceType, std::make_shared<const std::string>(std::move(sentence)));
  }

  void send(http::status status, std::string_view type, PageText text) {
    text_ = std::move(text);
    answer_.version(11);
    answer_.result(status);
    answer_.set(http::field::content_type, to_beast(type));
    answer_.content_length(text_->size());
    // A reader of HTTP/1.0 does not expect that the connection stays open.
    answer_.set(http::field::connection, keeps_alive_ ? "keep-alive" : "close");
    answer_.body() = {text_->data(), text_->size()};
    serializer_.emplace(answer_);
    enter(State::answering, limits_.answer);
    const auto then = [self = shared_from_this()](const error_code& error, std::size_t) { self->sent(error); };
    if (parser_->get().method() == http::verb::head) {
      http::async_write_header(stream_, *serializer_, then);
    } else {
      http::async_write(stream_, *serializer_, then);
    }
  }

  void sent(const error_code& error) {
    if (!is_open()) return end();
    text_ = nullptr;
    serializer_.reset();
    answer_ = {};
    if (error) return end();
    if (!keeps_alive_) return leave();
    if (received_.size() > 0) return ask();
    enter(State::idle, limits_.idle);
    stream_.async_read_some(received_.prepare(kReadAhead),
                            [self = shared_from_this()](const error_code& failed, std::size_t size) {
                              if (failed || !self->is_open()) return self->end();
                              self->received_.commit(size);
                              self->ask();
                            });
  }

  // Waits until the reader closes: closing first would discard the answer of a reader that still sends.
  void leave() {
    error_code ignored;
    stream_.socket().shutdown(Stream::socket_type::shutdown_send, ignored);
    enter(State::leaving, limits_.leaving);
    discard();
  }

  void discard() {
    received_.clear();
    stream_.async_read_some(received_.prepare(kReadAhead),
                            [self = shared_from_this()](const error_code& error, std::size_t size) {
                              self->discarded_ += size;
                              const bool enough = self->discarded_ > self->limits_.leaving_bytes;
                              error || enough || !self->is_open() ? self->end() : self->discard();
                            });
  }

  const PageLimits& limits_;
  const TakePageText take_text_;
  Stream stream_;
  beast::flat_buffer received_;  // not answered yet
  std::optional<Parser> parser_;
  Answer answer_;
  std::optional<http::response_serializer<Answer::body_type>> serializer_;
  PageText text_;  // the body of answer_
  bool keeps_alive_ = false;
  std::size_t discarded_ = 0;
  State state_ = State::asking;
  TimePoint since_{};
};

}  // namespace

std::shared_ptr<PageSession> PageSession::start(boost::asio::io_context& context, Descriptor connection,
                                                const PageLimits& limits, TakePageText take_text) {
  Stream::socket_type socket(context.get_executor());
  error_code error;
  socket.assign(boost::asio::ip::tcp::v4(), connection.get(), error);
  if (!error) connection.release();
  auto session = std::make_shared<BeastSession>(std::move(socket), limits, std::move(take_text));
  if (!error) session->start();
  return session;
}

}  // namespace axisgate::server
