#include "server/metrics/metrics_page.h"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "device/link/clock.h"
#include "tests/unit/connections/connection_fixtures.h"
#include "tests/unit/server/metrics_page.h"

namespace axisgate::server::metrics_page_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kGet = "GET /metrics HTTP/1.1\r\nHost: here\r\n\r\n";
constexpr const char* kHalf = "GET /metrics HTTP/1.1\r\nHost:";

// More text than kernels buffer for a reader with a small receive buffer.
const std::string kLongText = std::string(8 * 1024 * 1024, '#') + "\n";

class MetricsPageTest : public ::testing::Test {
 protected:
  void open(const PageLimits& limits = {}) {
    auto page = MetricsPage::open(
        {"127.0.0.1", 0},
        [this] {
          ++texts_;
          return text_;
        },
        limits);
    ASSERT_TRUE(page) << page.error().message;
    page_ = *std::move(page);
  }

  int port() const { return page_->address().port; }

  // Returns the answer to one request, after which the page closes the connection.
  std::string ask(const std::string& request) const {
    PageReader reader(port());
    reader.send(request);
    return reader.read_to_end();
  }

  std::vector<std::unique_ptr<PageReader>> readers_that_sent(const char* what, int count, int receive_buffer) const {
    std::vector<std::unique_ptr<PageReader>> readers;
    for (int i = 0; i < count; ++i) {
      readers.push_back(std::make_unique<PageReader>(PageReader::Unconnected{receive_buffer}));
      readers.back()->connect(port());
      EXPECT_TRUE(readers.back()->send(what));
    }
    return readers;
  }

  std::string text_ = "# HELP a A.\n# TYPE a counter\na 1\n";
  std::atomic<int> texts_ = 0;
  std::unique_ptr<MetricsPage> page_;
};

TEST_F(MetricsPageTest, IsReadByGet) {
  open();
  EXPECT_EQ(ask("GET /metrics HTTP/1.1\r\nConnection: close\r\n\r\n"),
            "HTTP/1.1 200 OK\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\nContent-Length: " +
                std::to_string(text_.size()) + "\r\nConnection: close\r\n\r\n" + text_);
  EXPECT_THAT(ask("GET /metrics?of=all HTTP/1.0\r\n\r\n"), AllOf(StartsWith("HTTP/1.1 200 "), EndsWith(text_)));
}

TEST_F(MetricsPageTest, AConnectionIsKeptForAsLongAsItsReaderAsks) {
  open();
  PageReader reader(port());
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(reader.send(kGet));
    EXPECT_THAT(reader.read_answer(),
                AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("Connection: keep-alive\r\n"), EndsWith(text_)));
  }
  ASSERT_TRUE(reader.send("GET /metrics HTTP/1.0\r\nConnection: Keep-Alive\r\n\r\n"));
  EXPECT_THAT(reader.read_answer(), HasSubstr("Connection: keep-alive\r\n"));
  ASSERT_TRUE(reader.send("GET /metrics HTTP/1.0\r\n\r\n"));
  EXPECT_THAT(reader.read_answer(), HasSubstr("Connection: close\r\n"));
  EXPECT_TRUE(reader.is_ended());
}

TEST_F(MetricsPageTest, RequestsMayComeInPiecesOrSeveralAtOnce) {
  open();
  PageReader reader(port());
  ASSERT_TRUE(reader.send(std::string(kGet) + kGet + kHalf));
  EXPECT_THAT(reader.read_answer(), EndsWith(text_));
  EXPECT_THAT(reader.read_answer(), EndsWith(text_));
  ASSERT_TRUE(reader.send(" here\r\n\r"));
  ASSERT_TRUE(reader.send("\n"));
  EXPECT_THAT(reader.read_answer(), EndsWith(text_));
}

TEST_F(MetricsPageTest, HeadHasTheLengthAndNoText) {
  open();
  EXPECT_THAT(ask("HEAD /metrics HTTP/1.0\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 200 "), EndsWith("\r\n\r\n"),
                    HasSubstr("Content-Length: " + std::to_string(text_.size()) + "\r\n")));
}

TEST_F(MetricsPageTest, OtherPathsAndMethodsAreRefusedInASentence) {
  open();
  EXPECT_THAT(ask("GET / HTTP/1.0\r\n\r\n"), AllOf(StartsWith("HTTP/1.1 404 "), HasSubstr("Only /metrics is here")));
  EXPECT_THAT(ask("GET /metrics/all HTTP/1.0\r\n\r\n"), StartsWith("HTTP/1.1 404 "));
  // The body of the request must not be read as a request.
  const std::string post = ask("POST /metrics HTTP/1.1\r\nContent-Length: 37\r\n\r\n" + std::string(kGet));
  EXPECT_THAT(post, AllOf(StartsWith("HTTP/1.1 405 "), HasSubstr("Allow: GET, HEAD\r\n"), EndsWith("use GET.\n")));
  EXPECT_EQ(texts_, 0);
}

TEST_F(MetricsPageTest, WhatIsNotHttpIsABadRequest) {
  open();
  for (const char* garbage :
       {"garbage\r\n\r\n", "\r\n\r\n", "GET /metrics\r\n\r\n", "GET  HTTP/1.1\r\n\r\n", "GET /a b HTTP/1.1\r\n\r\n",
        "GET /metrics HTTP/2.0\r\n\r\n", "\x16\x03\x01 / HTTP/1.1\r\n\r\n", "GET /metrics HTTP/1.1\r\nno field\r\n\r\n",
        "GET /metrics HTTP/1.1\r\n: none\r\n\r\n"}) {
    EXPECT_THAT(ask(garbage), StartsWith("HTTP/1.1 400 ")) << garbage;
  }
}

TEST_F(MetricsPageTest, AHeadMayBe8KiBAndNotMuchLonger) {
  open();
  const std::string begin = "GET /metrics HTTP/1.0\r\nLong: ", end = "\r\n\r\n";
  const std::string longest = begin + std::string(8192 - begin.size() - end.size(), 'x') + end;
  EXPECT_THAT(ask(longest), StartsWith("HTTP/1.1 200 "));
  // Boost.Beast does not count the request line.
  EXPECT_THAT(ask(begin + std::string(8192, 'x') + end), StartsWith("HTTP/1.1 431 "));
  // The sender receives the answer although the rest of the request is never read.
  EXPECT_THAT(ask(begin + std::string(100'000, 'x')), StartsWith("HTTP/1.1 431 "));
}

TEST_F(MetricsPageTest, HalfSentRequestsCannotKeepAScrapeAway) {
  open({.connections = 256, .head = seconds(60)});
  PageReader kept(port());
  ASSERT_TRUE(kept.send(kGet));
  EXPECT_THAT(kept.read_answer(), EndsWith(text_));
  const auto half = readers_that_sent(kHalf, 300, 0);
  const TimePoint begin = monotonic_now();
  EXPECT_THAT(metrics_page(port()), EndsWith(text_));
  EXPECT_LT(monotonic_now() - begin, seconds(1));
  // The first 46 of 302 connections were closed to make room.
  EXPECT_TRUE(kept.is_ended());
  for (std::size_t i = 0; i < 45; ++i) EXPECT_TRUE(half[i]->is_ended()) << i;
  ASSERT_TRUE(half[45]->send(" here\r\n\r\n"));
  EXPECT_THAT(half[45]->read_answer(), EndsWith(text_));
}

TEST_F(MetricsPageTest, ReadersThatDoNotReadDelayNobody) {
  text_ = kLongText;
  open();
  const auto readers = readers_that_sent(kGet, 50, 4096);
  const TimePoint begin = monotonic_now();
  EXPECT_EQ(metrics_page(port()).size() / 1024, kLongText.size() / 1024);
  EXPECT_LT(monotonic_now() - begin, seconds(5));
  EXPECT_THAT(readers[0]->read_answer(), EndsWith("#\n"));
}

TEST_F(MetricsPageTest, WhereAllReadSlowlyTheSlowestMakesRoom) {
  text_ = kLongText;
  open({.connections = 3});
  const auto readers = readers_that_sent(kGet, 3, 4096);
  for (const auto& reader : readers) ASSERT_TRUE(reader->read_more());
  EXPECT_THAT(metrics_page(port()), EndsWith("#\n"));
  const std::string displaced = readers[0]->read_to_end();
  EXPECT_LT(displaced.size(), kLongText.size());
  EXPECT_THAT(readers[1]->read_answer(), EndsWith("#\n"));
}

TEST_F(MetricsPageTest, AHeadHasItsTime) {
  open({.head = milliseconds(50)});
  const TimePoint begin = monotonic_now();
  PageReader silent(port()), half(port());
  half.send(kHalf);
  EXPECT_TRUE(silent.is_ended());
  EXPECT_TRUE(half.is_ended());
  EXPECT_GE(monotonic_now() - begin, milliseconds(50));
  EXPECT_LT(monotonic_now() - begin, seconds(10));
}

TEST_F(MetricsPageTest, SoHasTheHeadOfALaterRequest) {
  open({.head = milliseconds(500), .idle = seconds(60)});
  PageReader reader(port());
  ASSERT_TRUE(reader.send(kGet));
  EXPECT_THAT(reader.read_answer(), EndsWith(text_));
  ASSERT_TRUE(reader.send(kHalf));
  EXPECT_TRUE(reader.is_ended());
}

TEST_F(MetricsPageTest, AnIdleConnectionHasItsTime) {
  open({.head = seconds(60), .idle = milliseconds(50)});
  PageReader reader(port());
  ASSERT_TRUE(reader.send(kGet));
  EXPECT_THAT(reader.read_answer(), EndsWith(text_));
  EXPECT_TRUE(reader.is_ended());
}

TEST_F(MetricsPageTest, AnAnswerHasItsTimeToBeTaken) {
  text_ = kLongText;
  open({.answer = milliseconds(50)});
  const auto readers = readers_that_sent(kGet, 1, 4096);
  // Reading everything would take seconds.
  EXPECT_LT(readers[0]->read_to_end(milliseconds(1)).size(), kLongText.size());
}

TEST_F(MetricsPageTest, AReaderThatDoesNotCloseIsLeftAfterAWhile) {
  open({.leaving = milliseconds(50)});
  PageReader reader(port());
  ASSERT_TRUE(reader.send("GET /metrics HTTP/1.0\r\n\r\n"));
  EXPECT_THAT(reader.read_to_end(), EndsWith(text_));
  const TimePoint end = monotonic_now() + seconds(10);
  // Sending fails only on a closed connection.
  while (reader.send("x") && monotonic_now() < end) std::this_thread::sleep_for(milliseconds(5));
  EXPECT_FALSE(reader.send("x"));
}

TEST_F(MetricsPageTest, OneThatSendsWithoutAnEndIsLeftAfterAMebibyte) {
  open({.leaving = seconds(60)});
  PageReader reader(port());
  ASSERT_TRUE(reader.send("POST /metrics HTTP/1.0\r\nContent-Length: 9999999999\r\n\r\n"));
  const std::string piece(64 * 1024, 'x');
  const TimePoint end = monotonic_now() + seconds(10);
  while (reader.send(piece) && monotonic_now() < end) {
  }
  EXPECT_FALSE(reader.send(piece));
}

TEST_F(MetricsPageTest, ABodyIsNeverReadAsARequest) {
  open();
  for (const char* body : {"Content-Length: 9999999999", "Transfer-Encoding: gzip", "Transfer-Encoding: chunked"}) {
    const std::string answer = ask(std::string("GET /metrics HTTP/1.1\r\n") + body + "\r\n\r\n" + kGet);
    EXPECT_THAT(answer, AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("Connection: close\r\n"), EndsWith(text_)))
        << body;
  }
}

TEST_F(MetricsPageTest, ATextServesAllWhoAskSoonAfterwards) {
  open({.text_age = seconds(3600)});
  for (int i = 0; i < 20; ++i) EXPECT_THAT(metrics_page(port()), EndsWith(text_));
  EXPECT_EQ(texts_, 1);
}

TEST_F(MetricsPageTest, AnOldTextIsNotSent) {
  open({.text_age = {}});
  for (int i = 0; i < 3; ++i) EXPECT_THAT(metrics_page(port()), EndsWith(text_));
  EXPECT_EQ(texts_, 3);
}

TEST_F(MetricsPageTest, WithoutDescriptorsANewConnectionTakesThePlaceOfAnother) {
  open();
  const auto half = readers_that_sent(kHalf, 3, 0);
  EXPECT_THAT(metrics_page(port()), EndsWith(text_));
  PageReader late(PageReader::Unconnected{});
  const NoDescriptors none;
  late.connect(port());
  ASSERT_TRUE(late.send("GET /metrics HTTP/1.0\r\n\r\n"));
  EXPECT_THAT(late.read_to_end(), EndsWith(text_));
}

TEST_F(MetricsPageTest, WithoutDescriptorsAndConnectionsItWaitsForOne) {
  open({.accept_pause = milliseconds(1)});
  PageReader late(PageReader::Unconnected{});
  auto none = std::make_unique<NoDescriptors>();
  late.connect(port());
  ASSERT_TRUE(late.send("GET /metrics HTTP/1.0\r\n\r\n"));
  none.reset();
  EXPECT_THAT(late.read_to_end(), EndsWith(text_));
}

TEST_F(MetricsPageTest, EndsWithItsReaders) {
  text_ = kLongText;
  open();
  const auto slow = readers_that_sent(kGet, 3, 4096);
  const auto half = readers_that_sent(kHalf, 3, 0);
  EXPECT_THAT(metrics_page(port()), EndsWith("#\n"));
  const std::size_t before = open_descriptors();
  page_.reset();
  EXPECT_LT(open_descriptors(), before);
  for (const auto& reader : half) EXPECT_TRUE(reader->is_ended());
}

}  // namespace
}  // namespace axisgate::server::metrics_page_test
