// The front on real descriptors: which sources are served in full.
#include "server/front/front.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/front/front_bed.h"

namespace axisgate::front::front_test {
namespace {

using server::Acceptor;
using testing::HasSubstr;
using testing::SizeIs;

class FrontTest : public testing::Test {
 protected:
  // Returns a client that has sent its first call; the answers are never read.
  Descriptor client_with_a_call() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()), 0);
    front_.enter(Descriptor(ends[0]), Acceptor::Service::all, Acceptor::Origin::this_machine);
    const Headers headers = {{":method", "POST"},
                             {":scheme", "http"},
                             {":path", "/forward"},
                             {":authority", "x"},
                             {"content-type", "application/grpc"}};
    const std::string bytes = std::string(kPreface) + settings_frame({}) +
                              frame(FrameType::headers, kEndHeaders, 1, encode_without_table(headers));
    EXPECT_EQ(::write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    return Descriptor(ends[1]);
  }
  void run_until_judged(std::size_t calls) {
    const TimePoint limit = monotonic_now() + std::chrono::seconds(20);
    while (filter_.decided.size() < calls && monotonic_now() < limit) io_.run_for(std::chrono::milliseconds(1));
    ASSERT_THAT(filter_.decided, SizeIs(calls));
  }

  boost::asio::io_context io_;
  TestCallFilter filter_;
  std::vector<Descriptor> to_grpc_;
  FrontLimits limits_ = [] {
    FrontLimits limits;
    limits.source.connections = {0.001, 2};
    return limits;
  }();
  Front front_{Strand(io_.get_executor()),
               filter_,
               std::nullopt,
               [this](Descriptor socket) { to_grpc_.push_back(std::move(socket)); },
               [](const Peer&, const Closing&) {},
               limits_};
};

TEST_F(FrontTest, ASourceThatConnectsTooOftenIsServedStopsOnly) {
  std::vector<Descriptor> clients;
  for (int i = 0; i < 2; ++i) clients.push_back(client_with_a_call());
  run_until_judged(2);
  EXPECT_THAT(to_grpc_, SizeIs(2));
  clients.push_back(client_with_a_call());
  run_until_judged(3);
  EXPECT_THAT(to_grpc_, SizeIs(2));
}

TEST_F(FrontTest, WhatGrpcSaidLastReachesTheClient) {
  const Descriptor client = client_with_a_call();
  run_until_judged(1);
  bool has_left = false;
  front_.when_grpc_has_left([&] { has_left = true; });
  const auto run_until_it_has_left = [&](std::chrono::milliseconds wait) {
    const TimePoint limit = monotonic_now() + wait;
    while (!has_left && monotonic_now() < limit) io_.run_for(std::chrono::milliseconds(1));
    return has_left;
  };
  ASSERT_THAT(to_grpc_, SizeIs(1));
  EXPECT_FALSE(run_until_it_has_left(std::chrono::milliseconds(20)));
  const std::string bytes = settings_frame({}) +
                            frame(FrameType::headers, kEndHeaders, 1, encode_without_table({{":status", "200"}})) +
                            frame(FrameType::data, 0, 1, "farewell");
  ASSERT_EQ(::write(to_grpc_[0].get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  to_grpc_.clear();
  ASSERT_TRUE(run_until_it_has_left(std::chrono::seconds(20)));
  std::string received(4096, 0);
  const auto size = ::read(client.get(), received.data(), received.size());
  ASSERT_GT(size, 0);
  received.resize(static_cast<std::size_t>(size));
  EXPECT_THAT(received, HasSubstr("farewell"));
}

}  // namespace
}  // namespace axisgate::front::front_test
