// Tests of the addresses of daemons, and of the credentials for them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "axisgate/stage.h"
#include "clients/cpp/src/target.h"

namespace axisgate::client {
namespace {

struct Row {
  const char* typed;
  const char* address;
};

TEST(Addresses, OfTargets) {
  const Row rows[] = {
      {"localhost", "localhost:50203"},
      {"localhost:50051", "localhost:50051"},
      {"gateway.lab", "gateway.lab:50203"},
      {"192.168.0.5", "192.168.0.5:50203"},
      {"192.168.0.5:50204", "192.168.0.5:50204"},
      {"::1", "[::1]:50203"},
      {"fe80::2:50051", "[fe80::2:50051]:50203"},
      {"[::1]", "[::1]:50203"},
      {"[::1]:50051", "[::1]:50051"},
      {"/run/axisgate/axisgate.sock", "unix:/run/axisgate/axisgate.sock"},
      {"lab/x.sock", "unix:lab/x.sock"},
      {"x.sock", "unix:x.sock"},
      {"./socket", "unix:./socket"},
      {"lab/a:1", "unix:lab/a:1"},
      {"unix:x", "unix:x"},
      {"unix:///run/x.sock", "unix:///run/x.sock"},
      {"dns:///gateway.lab:50203", "dns:///gateway.lab:50203"},
      {"ipv6:[::1]:50203", "ipv6:[::1]:50203"},
  };
  for (const auto& [typed, expected] : rows) EXPECT_EQ(address(typed, false), expected) << typed;
}

// TLS always means the port of [network], because `listen` accepts only loopback addresses.
TEST(Addresses, OfTargetsWithTls) {
  const Row rows[] = {
      {"gateway.lab", "gateway.lab:50204"},
      {"gateway.lab:443", "gateway.lab:443"},
      {"[2001:db8::1]", "[2001:db8::1]:50204"},
  };
  for (const auto& [typed, expected] : rows) EXPECT_EQ(address(typed, true), expected) << typed;
}

TEST(Addresses, OfTheDefaultDaemon) {
  ASSERT_EQ(::setenv("AXISGATE_SOCKET", "socket", 1), 0);
  EXPECT_EQ(address("", false), "unix:socket") << "it is a path, whatever it looks like";
  ASSERT_EQ(::unsetenv("AXISGATE_SOCKET"), 0);
}

TEST(Targets, SendNoTokenUnencryptedToAnotherMachine) {
  EXPECT_THROW(to_target({.target = "lab", .token = "secret"}), InvalidArgument);
  EXPECT_THROW(to_target({.target = "127.0.0.1.example.org", .token = "secret"}), InvalidArgument);
  EXPECT_EQ(to_target({.target = "127.0.0.1", .token = "secret"}).token, "secret");
  EXPECT_EQ(to_target({.target = "lab", .token = "secret", .ca = "ca.pem"}).address, "lab:50204");
  EXPECT_THROW(to_target({.certificate = "me.pem"}), InvalidArgument);
}

}  // namespace
}  // namespace axisgate::client
