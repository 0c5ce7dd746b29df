// Causes for which the front closes a connection.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "server/front/front.h"
#include "tests/unit/front/front_bed.h"

namespace axisgate::front::closing_test {
namespace {

using std::chrono::milliseconds;
using testing::IsEmpty;

class ClosingTest : public ::testing::Test {
 protected:
  void connect(const FrontLimits& limits) {
    front_.emplace(
        Strand(io_.get_executor()), filter_, std::nullopt, [](Descriptor) {},
        [this](const Peer& peer, const Closing& closing) {
          EXPECT_EQ(peer.source, "uid " + std::to_string(::geteuid()));
          causes_.push_back(closing.cause);
        },
        limits);
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    client_ = Descriptor(ends[0]);
    front_->enter(Descriptor(ends[1]), server::Acceptor::Service::all, server::Acceptor::Origin::this_machine);
  }
  void say(const std::string& bytes) const {
    EXPECT_EQ(::send(client_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
  }
  std::string call(const std::string& path) {
    return frame(FrameType::headers, kEndHeaders, 1,
                 encoder_.encode({{":method", "POST"},
                                  {":scheme", "http"},
                                  {":path", path},
                                  {":authority", "x"},
                                  {"content-type", "application/grpc"}}));
  }
  // Waits until the connection is closed and returns the cause.
  std::optional<Cause> cause() {
    const TimePoint limit = monotonic_now() + std::chrono::seconds(20);
    while (causes_.empty() && monotonic_now() < limit) io_.run_one_for(milliseconds(100));
    return causes_.empty() ? std::nullopt : std::optional(causes_.front());
  }

  boost::asio::io_context io_;
  TestCallFilter filter_;
  std::vector<Cause> causes_;
  std::optional<Front> front_;
  Descriptor client_;
  HeaderEncoder encoder_;
};

TEST_F(ClosingTest, NobodyCalled) {
  FrontLimits limits;
  limits.silence = milliseconds(1);
  connect(limits);
  say(std::string(kPreface) + settings_frame({}));
  EXPECT_EQ(cause(), Cause::no_call);
}

TEST_F(ClosingTest, AFrameWasBegunAndNotFinished) {
  FrontLimits limits;
  limits.pace.span = milliseconds(1);
  connect(limits);
  say(std::string(kPreface) + settings_frame({}) + call("/stop") + "a part");
  EXPECT_EQ(cause(), Cause::frame_unfinished);
}

// The front cannot write its GOAWAY after the client has gone.
TEST_F(ClosingTest, AClientThatIsGoneByThenDidTheSame) {
  connect({});
  say("GET / HTTP/1.1\r\n\r\n");
  client_ = Descriptor();
  EXPECT_EQ(cause(), Cause::protocol_error);
}

TEST_F(ClosingTest, AClientThatLeavesGivesNoCause) {
  connect({});
  say(std::string(kPreface) + settings_frame({}) + call("/stop"));
  io_.run_for(milliseconds(1));
  client_ = Descriptor();
  while (io_.run_one_for(milliseconds(1)) > 0) {
  }
  front_.reset();
  EXPECT_THAT(causes_, IsEmpty());
}

}  // namespace
}  // namespace axisgate::front::closing_test
