#include "server/metrics/page_answer.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace axisgate::server {
namespace {

// The format that prometheus::TextSerializer writes.
constexpr std::string_view kPageType = "text/plain; version=0.0.4; charset=utf-8";
constexpr std::string_view kSentenceType = "text/plain; charset=utf-8";

PageAnswer compose(std::string_view status, std::string_view type, PageText body, bool keep_alive) {
  std::string head = fmt::format("HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: {}\r\n", status,
                                 type, body->size(), keep_alive ? "keep-alive" : "close");
  return {std::move(head), std::move(body), keep_alive};
}

PageAnswer say(std::string_view status, std::string sentence, bool keep_alive = false) {
  return compose(status, kSentenceType, std::make_shared<const std::string>(std::move(sentence)), keep_alive);
}

PageAnswer end_head(PageAnswer answer) {
  answer.head += "\r\n";
  return answer;
}

PageAnswer choose(const PageRequest& request, const TakePageText& take_text) {
  if (request.path != "/metrics") {
    return say("404 Not Found", "Only /metrics is here: the metrics of axisgated.\n", request.keep_alive);
  }
  if (request.method == "GET" || request.method == "HEAD") {
    return compose("200 OK", kPageType, take_text(), request.keep_alive);
  }
  PageAnswer refusal = say("405 Method Not Allowed", "This page can only be read: use GET.\n", request.keep_alive);
  refusal.head += "Allow: GET, HEAD\r\n";
  return refusal;
}

}  // namespace

PageAnswer answer(const PageRequest& request, const TakePageText& take_text) {
  PageAnswer chosen = end_head(choose(request, take_text));
  if (request.method == "HEAD") chosen.body = nullptr;
  return chosen;
}

PageAnswer answer_malformed() {
  return end_head(say("400 Bad Request", "This is not a request of HTTP/1.0 or HTTP/1.1.\n"));
}

PageAnswer answer_too_long() {
  return end_head(say("431 Request Header Fields Too Large", "The head of the request is too long.\n"));
}

}  // namespace axisgate::server
