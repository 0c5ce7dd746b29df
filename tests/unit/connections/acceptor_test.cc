#include "server/connections/acceptor.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <chrono>
#include <optional>
#include <vector>

#include "tests/unit/connections/connection_fixtures.h"

namespace axisgate::server::acceptor_test {
namespace {

using link_test::EventLoop;
using Service = Acceptor::Service;

class AcceptorTest : public ::testing::Test {
 protected:
  struct Connection {
    Descriptor descriptor;
    Service service;
  };

  void accept(ConnectionLimits limits, Acceptor::Accept how = Acceptor::accept_connection) {
    acceptor_.emplace(
        loop_.strand(), limits,
        [this](Descriptor descriptor, Service service, Acceptor::Origin) {
          connections_.push_back({std::move(descriptor), service});
        },
        std::move(how));
    acceptor_->listen(server_.take_listener());
  }

  // Waits for the next accepted connection and returns its service.
  Service next() {
    const std::size_t before = connections_.size();
    EXPECT_TRUE(loop_.run_until([&] { return connections_.size() > before; }));
    return connections_.size() > before ? connections_.back().service : Service::stop_only;
  }

  // Repeatedly connects more clients than the reserve has room for and checks that every descriptor is closed again.
  void expect_no_descriptor_lost() {
    const std::size_t before = open_descriptors();
    for (int round = 0; round < 3; ++round) {
      std::vector<Descriptor> clients;
      for (int i = 0; i < 6; ++i) {
        clients.push_back(server_.connected());
        EXPECT_EQ(next(), Service::stop_only);
      }
      EXPECT_NE(open_descriptors(), before);
      clients.clear();
      connections_.clear();
      EXPECT_TRUE(loop_.run_until([&] { return open_descriptors() == before; }));
      EXPECT_EQ(acceptor_->counts().in_reserve, 0u);
    }
  }

  EventLoop loop_;
  UnixServer server_;
  std::vector<Connection> connections_;
  std::optional<Acceptor> acceptor_;
};

TEST_F(AcceptorTest, HandsOverWhatItAcceptsAndCountsWhatIsOpen) {
  accept({2});
  const Descriptor first = server_.connected(), second = server_.connected();
  EXPECT_EQ(next(), Service::all);
  EXPECT_EQ(next(), Service::all);
  EXPECT_NE(::fcntl(connections_[0].descriptor.get(), F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(acceptor_->counts().open, 2u);
  connections_[0].descriptor.reset();
  EXPECT_EQ(acceptor_->counts().open, 1u);
  EXPECT_EQ(acceptor_->counts().accepted, 2u);
}

TEST_F(AcceptorTest, BeyondTheLimitAConnectionIsForStopsUntilAnotherHasClosed) {
  accept({1});
  const Descriptor first = server_.connected();
  EXPECT_EQ(next(), Service::all);
  const Descriptor second = server_.connected();
  EXPECT_EQ(next(), Service::stop_only);
  EXPECT_EQ(acceptor_->counts().reserved, 1u);
  EXPECT_EQ(acceptor_->counts().in_reserve, 1u);
  connections_[0].descriptor.reset();
  const Descriptor third = server_.connected();
  EXPECT_EQ(next(), Service::all);
}

TEST_F(AcceptorTest, AFloodOfConnectionsDoesNotFillTheReserve) {
  accept({0, 2});
  const Descriptor first = server_.connected();
  next();
  const Descriptor second = server_.connected();
  next();
  EXPECT_FALSE(ended(first));
  const Descriptor third = server_.connected();
  EXPECT_EQ(next(), Service::stop_only);
  EXPECT_TRUE(ended(first));
  EXPECT_FALSE(ended(second));
  EXPECT_FALSE(ended(third));
  EXPECT_EQ(acceptor_->counts().displaced, 1u);
}

TEST_F(AcceptorTest, Hazard55DescriptorsRunOutAndComeBackAndAStopsConnectionGetsThrough) {
  accept({100});
  connections_.reserve(100);
  const Descriptor stop = UnixServer::client(), later = UnixServer::client();
  {
    const NoDescriptors none;
    server_.connect(stop);
    EXPECT_EQ(next(), Service::stop_only);
    EXPECT_EQ(acceptor_->counts().out_of_descriptors, 1u);
  }
  server_.connect(later);
  EXPECT_EQ(next(), Service::all);
}

// The test plays gRPC, which closes a connection some time after the reserve has shut it down.
TEST_F(AcceptorTest, Hazard55WithoutDescriptorsAFloodIsAcceptedToItsLast) {
  accept({100, 2});
  std::vector<Descriptor> clients(20);
  for (Descriptor& client : clients) client = UnixServer::client();
  const NoDescriptors none;
  for (const Descriptor& client : clients) server_.connect(client);
  while (connections_.size() < clients.size()) {
    for (Connection& connection : connections_) {
      if (connection.descriptor.valid() && ended(connection.descriptor)) connection.descriptor.reset();
    }
    ASSERT_EQ(next(), Service::stop_only);
  }
  EXPECT_EQ(acceptor_->counts().displaced, 18u);
  EXPECT_FALSE(ended(clients[18]));
  EXPECT_FALSE(ended(clients[19]));
}

class AcceptErrors : public AcceptorTest, public ::testing::WithParamInterface<int> {};

TEST_P(AcceptErrors, Hazard55TheListenerLives) {
  int failures = 5;
  accept({100}, [&failures](int listener) {
    if (failures == 0) return Acceptor::accept_connection(listener);
    --failures;
    errno = GetParam();
    return -1;
  });
  const Descriptor client = server_.connected();
  next();
  EXPECT_EQ(failures, 0);
}

INSTANTIATE_TEST_SUITE_P(Errno, AcceptErrors,
                         ::testing::Values(EMFILE, ENFILE, ENOBUFS, ENOMEM, ECONNABORTED, EINTR, EAGAIN, EINVAL));

TEST_F(AcceptorTest, RestsWhenNothingCanBeAccepted) {
  std::vector<TimePoint> tried;
  accept({100}, [&tried](int) {
    tried.push_back(monotonic_now());
    errno = EMFILE;
    return -1;
  });
  const Descriptor client = server_.connected();
  EXPECT_TRUE(loop_.run_until([&] { return tried.size() >= 20; }));
  // Each round tries twice, once normally and once for the reserve; rounds are 5 ms apart.
  EXPECT_GE(tried[19] - tried[0], std::chrono::milliseconds(9 * 5));
}

TEST_F(AcceptorTest, WhatTheReserveNeedsIsTakenBackWhenItsConnectionsHaveEnded) {
  accept({0, 4});
  expect_no_descriptor_lost();
}

TEST_F(AcceptorTest, BeyondOnesShareAConnectionIsForStopsUntilAnotherOfHisHasClosed) {
  accept({.open = 100, .of_one = 1});
  const Descriptor first = server_.connected();
  EXPECT_EQ(next(), Service::all);
  const Descriptor second = server_.connected();
  EXPECT_EQ(next(), Service::stop_only);
  EXPECT_EQ(acceptor_->counts().open, 1u);
  EXPECT_EQ(acceptor_->counts().reserved, 1u);
  EXPECT_EQ(acceptor_->counts().in_reserve, 1u);
  connections_[0].descriptor.reset();
  const Descriptor third = server_.connected();
  EXPECT_EQ(next(), Service::all);
}

TEST_F(AcceptorTest, AFloodBeyondOnesShareDisplacesItself) {
  accept({.open = 100, .reserve = 2, .of_one = 0});
  const Descriptor first = server_.connected();
  next();
  const Descriptor second = server_.connected();
  next();
  EXPECT_FALSE(ended(first));
  const Descriptor third = server_.connected();
  EXPECT_EQ(next(), Service::stop_only);
  EXPECT_TRUE(ended(first));
  EXPECT_FALSE(ended(second));
  EXPECT_FALSE(ended(third));
  EXPECT_EQ(acceptor_->counts().displaced, 1u);
}

TEST_F(AcceptorTest, WhatTheReserveNeedsIsTakenBackAfterAFloodBeyondOnesShare) {
  accept({.open = 100, .reserve = 4, .of_one = 0});
  expect_no_descriptor_lost();
}

}  // namespace
}  // namespace axisgate::server::acceptor_test
