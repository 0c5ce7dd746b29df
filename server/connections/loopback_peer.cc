#include "server/connections/loopback_peer.h"

#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "device/link/descriptor.h"

namespace axisgate::server {
namespace {

struct End {
  std::array<__be32, 4> address{};
  __be16 port = 0;
};

std::optional<End> end_of(const sockaddr_storage& address) {
  End end;
  if (address.ss_family == AF_INET) {
    const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(address);
    end.address[0] = ipv4.sin_addr.s_addr;
    end.port = ipv4.sin_port;
    return end;
  }
  if (address.ss_family != AF_INET6) return std::nullopt;
  const auto& ipv6 = reinterpret_cast<const sockaddr_in6&>(address);
  std::memcpy(end.address.data(), &ipv6.sin6_addr, sizeof(ipv6.sin6_addr));
  end.port = ipv6.sin6_port;
  return end;
}

bool is_loopback(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    constexpr std::uint32_t kNet = 127;
    return ntohl(reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr) >> 24 == kNet;
  }
  return address.ss_family == AF_INET6 &&
         IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
}

struct Question {
  nlmsghdr header{};
  inet_diag_req_v2 socket{};
};

// Builds the question about the peer's own socket, with the two ends exchanged.
std::optional<Question> question_about(int connection) {
  sockaddr_storage ours{}, theirs{};
  socklen_t size = sizeof(ours);
  if (::getsockname(connection, reinterpret_cast<sockaddr*>(&ours), &size) != 0) return std::nullopt;
  size = sizeof(theirs);
  if (::getpeername(connection, reinterpret_cast<sockaddr*>(&theirs), &size) != 0) return std::nullopt;
  const auto source = end_of(theirs), destination = end_of(ours);
  if (!source || !destination || !is_loopback(theirs)) return std::nullopt;
  Question question;
  question.header.nlmsg_len = sizeof(question);
  question.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
  question.header.nlmsg_flags = NLM_F_REQUEST;
  question.socket.sdiag_family = static_cast<__u8>(theirs.ss_family);
  question.socket.sdiag_protocol = IPPROTO_TCP;
  question.socket.idiag_states = 1U << TCP_ESTABLISHED;
  inet_diag_sockid& id = question.socket.id;
  id.idiag_sport = source->port;
  id.idiag_dport = destination->port;
  std::memcpy(id.idiag_src, source->address.data(), sizeof(id.idiag_src));
  std::memcpy(id.idiag_dst, destination->address.data(), sizeof(id.idiag_dst));
  id.idiag_cookie[0] = id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
  return question;
}

}  // namespace

std::optional<uid_t> loopback_uid(int connection) {
  const std::optional<Question> question = question_about(connection);
  if (!question) return std::nullopt;
  const Descriptor kernel(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  if (!kernel.valid()) return std::nullopt;
  if (::send(kernel.get(), &*question, sizeof(*question), 0) != static_cast<ssize_t>(sizeof(*question))) {
    return std::nullopt;
  }
  // The kernel answers within send(), so the answer is already there.
  alignas(nlmsghdr) std::array<char, 1024> answer{};
  const ssize_t size = ::recv(kernel.get(), answer.data(), answer.size(), MSG_DONTWAIT);
  if (size < static_cast<ssize_t>(NLMSG_LENGTH(sizeof(inet_diag_msg)))) return std::nullopt;
  const auto* header = reinterpret_cast<const nlmsghdr*>(answer.data());
  if (header->nlmsg_type != SOCK_DIAG_BY_FAMILY) return std::nullopt;
  return static_cast<const inet_diag_msg*>(NLMSG_DATA(header))->idiag_uid;
}

}  // namespace axisgate::server
