#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <string>

#include "server/connections/callers.h"
#include "server/connections/descriptor_limit.h"
#include "server/connections/loopback_peer.h"
#include "server/connections/open_connections.h"
#include "server/connections/reserve.h"
#include "tests/unit/connections/connection_fixtures.h"
#include "tests/unit/link/tcp_fixtures.h"

namespace axisgate::server::connections_test {
namespace {

std::array<Descriptor, 2> socket_pair() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

TEST(OpenConnections, ANumberThatIsAnothersNowIsNotCounted) {
  OpenConnections open(1, 1);
  auto [one, other] = socket_pair();
  open.add(one.get(), "uid 1000");
  EXPECT_FALSE(open.has_room());
  // The descriptor's number is closed and assigned again.
  ASSERT_EQ(::dup2(other.get(), one.get()), one.get());
  EXPECT_TRUE(open.has_room());
  EXPECT_EQ(open.count(), 0u);
}

TEST(OpenConnections, OneOwnerHasRoomForHisShareOnly) {
  OpenConnections open(10, 2);
  auto [one, other] = socket_pair();
  auto [third, fourth] = socket_pair();
  open.add(one.get(), "uid 1000");
  EXPECT_TRUE(open.has_room_for("uid 1000"));
  open.add(other.get(), "uid 1000");
  EXPECT_FALSE(open.has_room_for("uid 1000"));
  EXPECT_TRUE(open.has_room());
  EXPECT_TRUE(open.has_room_for("192.168.0.7"));
  open.add(third.get(), "192.168.0.7");
  EXPECT_FALSE(open.has_room_for("uid 1000"));
  one.reset();
  EXPECT_TRUE(open.has_room_for("uid 1000"));
  EXPECT_EQ(open.count(), 2u);
}

TEST(Reserve, FreesWhatOneConnectionNeedsAndTakesItBack) {
  const std::size_t before = open_descriptors();
  Reserve reserve(2);
  EXPECT_EQ(open_descriptors(), before + 6);
  EXPECT_TRUE(reserve.open_place());
  EXPECT_EQ(open_descriptors(), before + 4);
  EXPECT_TRUE(reserve.restore());
  EXPECT_EQ(open_descriptors(), before + 6);
}

TEST(Reserve, WithoutDescriptorsItIsFilledWhenThereAreSome) {
  std::optional<Reserve> reserve;
  {
    const NoDescriptors none;
    reserve.emplace(2);
    EXPECT_FALSE(reserve->restore());
    EXPECT_FALSE(reserve->open_place());
  }
  EXPECT_TRUE(reserve->restore());
}

TEST(Reserve, AConnectionThatItCouldNotKeepIsLeftAlone) {
  Reserve reserve(1);
  auto [one, other] = socket_pair();
  {
    const NoDescriptors none;
    reserve.keep(one.get());
  }
  EXPECT_TRUE(reserve.open_place());
  EXPECT_FALSE(ended(other));
  EXPECT_EQ(reserve.displaced(), 0u);
}

TEST(Callers, TheKernelNamesTheUserOfAUnixSocketAlone) {
  const UnixServer server;
  const auto pair = socket_pair();
  EXPECT_EQ(peer_uid(pair[0].get()), ::geteuid());
  const Descriptor tcp(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  EXPECT_EQ(peer_uid(tcp.get()), std::nullopt);
}

TEST(Callers, AConnectionIsItsUsersAlsoOverLoopback) {
  const auto pair = socket_pair();
  EXPECT_EQ(connection_owner(pair[0].get()), "uid " + std::to_string(::geteuid()));
  link_test::SerialServer server;
  for (const char* from : {"127.0.0.1", "127.1.2.3"}) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    ASSERT_EQ(::inet_pton(AF_INET, from, &address.sin_addr), 1);
    const Descriptor client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    ASSERT_EQ(::bind(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ASSERT_EQ(::inet_pton(AF_INET, "127.0.0.1", &address.sin_addr), 1);
    address.sin_port = ::htons(server.settings().port);
    ASSERT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const Descriptor accepted = server.accept();
    EXPECT_EQ(connection_owner(accepted.get()), fmt::format("uid {} over TCP", ::geteuid()));
    EXPECT_EQ(loopback_uid(accepted.get()), ::geteuid());
  }
  const Descriptor alone(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  EXPECT_EQ(connection_owner(alone.get()), "nobody");
}

TEST(Callers, ANameIsTheLoginOrTheNumber) {
  EXPECT_EQ(caller_name(0), "unix root");
  EXPECT_EQ(caller_name(3'000'000'000), "unix uid 3000000000");
}

TEST(DescriptorLimit, LeavesRoomForTheRest) {
  EXPECT_EQ(connections_within(64), 10u);
  EXPECT_EQ(connections_within(384), 64u);
  EXPECT_EQ(connections_within(1024), 234u);
  EXPECT_EQ(connections_within(4288), 1322u);
  EXPECT_EQ(connections_within(12'608), 4096u);
  EXPECT_EQ(connections_within(1'000'000), 4096u);
}

TEST(DescriptorLimit, IsRaisedAsFarAsAllowed) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  ASSERT_GT(before.rlim_max, 512u);
  const rlimit low{256, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
  const std::size_t connections = raise_descriptor_limit();
  rlimit raised{};
  ::getrlimit(RLIMIT_NOFILE, &raised);
  EXPECT_EQ(raised.rlim_cur, std::min<rlim_t>(12'608, before.rlim_max));
  EXPECT_EQ(connections, connections_within(raised.rlim_cur));
  ::setrlimit(RLIMIT_NOFILE, &before);
}

}  // namespace
}  // namespace axisgate::server::connections_test
