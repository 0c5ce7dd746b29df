#include "device/link/tcp_socket.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "device/link/blocking_task.h"
#include "device/link/clock.h"

namespace axisgate {
namespace {

using boost::system::error_code;

struct Address {
  sockaddr_storage bytes{};
  socklen_t size = 0;
  int family = AF_UNSPEC;
};

// Result of a lookup. `error`: EAI_ code; 0: success.
struct Lookup {
  int error = 0;
  std::vector<Address> addresses;
};

Lookup look_up(const TcpSettings& settings) {
  addrinfo wanted{};
  wanted.ai_flags = AI_NUMERICSERV;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  Lookup result;
  result.error = ::getaddrinfo(settings.host.c_str(), std::to_string(settings.port).c_str(), &wanted, &found);
  if (result.error != 0) return result;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    Address address;
    address.size = entry->ai_addrlen;
    address.family = entry->ai_family;
    std::copy_n(reinterpret_cast<const char*>(entry->ai_addr), entry->ai_addrlen,
                reinterpret_cast<char*>(&address.bytes));
    result.addresses.push_back(address);
  }
  ::freeaddrinfo(found);
  return result;
}

// Runs one lookup at a time, even if many attempts abandon the wait for its answer. An answer that comes too late for
// its attempt serves the next attempt; otherwise a name whose lookup takes longer than an attempt would never be known.
class NameServer : public std::enable_shared_from_this<NameServer> {
 public:
  using Answered = std::function<bool(const Lookup&)>;  // returns whether the attempt still waited

  explicit NameServer(TcpSettings settings) : settings_(std::move(settings)) {}

  void ask(const Strand& strand, Answered answered) {
    if (const auto known = std::exchange(late_, {})) {
      boost::asio::post(strand, [answered = std::move(answered), known = *known] { answered(known); });
      return;
    }
    answered_ = std::move(answered);
    if (asking_) return;
    const auto tell = [weak = weak_from_this()](const Lookup& found) {
      if (const auto self = weak.lock()) self->tell(found);
    };
    asking_ = run_blocking_task<Lookup>(
        strand, [settings = settings_] { return look_up(settings); }, tell);
  }

 private:
  void tell(const Lookup& found) {
    asking_.reset();
    if (!std::exchange(answered_, {})(found)) late_ = found;
  }

  const TcpSettings settings_;
  std::shared_ptr<void> asking_;
  Answered answered_;
  std::optional<Lookup> late_;
};

std::string text_of(int error) { return std::generic_category().message(error); }

tl::unexpected<Problem> refuse(std::string message, std::string hint) {
  return fail(Reason::link_down, std::move(message), std::move(hint));
}

OpenedLine refuse_lookup(const TcpSettings& settings, int error) {
  if (error == EAI_NONAME || error == EAI_NODATA) {
    return refuse(settings.host + " is not known", "Check the spelling, or give the serial server's address itself.");
  }
  return refuse(fmt::format("{} could not be looked up: {}", settings.host, ::gai_strerror(error)),
                "Check this machine's name server, or give the serial server's address itself.");
}

OpenedLine refuse_connect(const TcpSettings& settings, int error) {
  switch (error) {
    case ECONNREFUSED:
      return refuse(
          "connection refused by " + to_string(settings),
          "Many serial servers take one connection to a raw port: end the program that has it. Or the port is "
          "another, or not set to raw TCP.");
    case ETIMEDOUT:
      return refuse(
          fmt::format("no answer from {} within {} s", to_string(settings),
                      std::chrono::duration_cast<std::chrono::seconds>(kConnectLimit).count()),
          "Check that the serial server is switched on and on this network, and that no firewall is between.");
    default:
      return refuse(fmt::format("{} cannot be reached: {}", to_string(settings), text_of(error)),
                    "Check the address and this machine's network.");
  }
}

template <class Value>
void set(int socket, int level, int option, Value value) {
  const int number = static_cast<int>(value);
  ::setsockopt(socket, level, option, &number, sizeof number);
}

// Disables the collecting of bytes, which gains nothing because every command waits for its answer, and enables the
// detection of a serial server that was switched off.
void set_options(int socket) {
  set(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  set(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, kUnacknowledgedLimit.count());
  set(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  set(socket, IPPROTO_TCP, TCP_KEEPIDLE, kKeepAliveIdle.count());
  set(socket, IPPROTO_TCP, TCP_KEEPINTVL, kKeepAliveInterval.count());
  set(socket, IPPROTO_TCP, TCP_KEEPCNT, kKeepAliveProbes);
}

// One attempt, from the lookup of the name to the connection. Its handlers refer to it weakly, so releasing it ends it.
class Attempt : public std::enable_shared_from_this<Attempt> {
 public:
  Attempt(const Strand& strand, TcpSettings settings, std::shared_ptr<NameServer> names, OnOpened opened)
      : settings_(std::move(settings)),
        names_(std::move(names)),
        opened_(std::move(opened)),
        strand_(strand),
        socket_(strand),
        limit_(strand),
        end_(monotonic_now() + kConnectLimit) {}

  void begin() {
    wait_at_most(kConnectLimit, [](Attempt& self) { self.tell(refuse_lookup(self.settings_, EAI_AGAIN)); });
    names_->ask(strand_, [weak = weak_from_this()](const Lookup& found) {
      const auto self = weak.lock();
      if (self) self->on_found(found);
      return self != nullptr;
    });
  }

 private:
  // Ignores a queued handler of an earlier address.
  template <class Then>
  auto in_this_turn(Then then) {
    return [weak = weak_from_this(), turn = next_, then](const error_code& error) {
      const auto self = error ? nullptr : weak.lock();
      if (self && self->opened_ && self->next_ == turn) then(*self);
    };
  }

  template <class Then>
  void wait_at_most(Duration wait, Then then) {
    limit_.expires_after(wait);
    limit_.async_wait(in_this_turn(then));
  }

  void on_found(const Lookup& found) {
    if (!opened_) return;
    if (found.error != 0) return tell(refuse_lookup(settings_, found.error));
    addresses_ = found.addresses;
    connect_next(EAI_NONAME);
  }

  void connect_next(int error_so_far) {
    if (next_ == addresses_.size()) return tell(refuse_connect(settings_, error_so_far));
    const Address& address = addresses_[next_++];
    error_code ignored;
    socket_.close(ignored);
    Descriptor fresh(::socket(address.family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fresh.valid()) return connect_next(errno);
    set_options(fresh.get());
    const int begun = ::connect(fresh.get(), reinterpret_cast<const sockaddr*>(&address.bytes), address.size);
    if (begun != 0 && errno != EINPROGRESS) return connect_next(errno);
    error_code error;
    socket_.assign(fresh.get(), error);
    if (error) return connect_next(error.value());
    fresh.release();
    const auto left = static_cast<Duration::rep>(addresses_.size() - next_ + 1);
    wait_at_most((end_ - monotonic_now()) / left, [](Attempt& self) { self.connect_next(ETIMEDOUT); });
    socket_.async_wait(Socket::wait_write, in_this_turn([](Attempt& self) { self.on_connected(); }));
  }

  void on_connected() {
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(socket_.native_handle(), SOL_SOCKET, SO_ERROR, &error, &size);
    if (error != 0) return connect_next(error);
    tell(Descriptor(socket_.release()));
  }

  void tell(OpenedLine line) {
    limit_.cancel();
    error_code ignored;
    socket_.close(ignored);
    std::exchange(opened_, {})(std::move(line));
  }

  using Socket = boost::asio::posix::stream_descriptor;

  const TcpSettings settings_;
  const std::shared_ptr<NameServer> names_;
  OnOpened opened_;
  Strand strand_;
  Socket socket_;
  boost::asio::steady_timer limit_;
  const TimePoint end_;
  std::vector<Address> addresses_;
  std::size_t next_ = 0;
};

}  // namespace

std::string to_string(const TcpSettings& settings) {
  const bool version_6 = settings.host.find(':') != std::string::npos;
  return version_6 ? fmt::format("[{}]:{}", settings.host, settings.port)
                   : fmt::format("{}:{}", settings.host, settings.port);
}

Opener tcp_opener(TcpSettings settings) {
  const auto names = std::make_shared<NameServer>(settings);
  return [settings = std::move(settings), names](const Strand& strand, OnOpened opened) {
    const auto attempt = std::make_shared<Attempt>(strand, settings, names, std::move(opened));
    attempt->begin();
    return Opening(attempt);
  };
}

}  // namespace axisgate
