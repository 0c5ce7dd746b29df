#include "device/link/pty_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <utility>

namespace axisgate {
namespace {

// Sets packet mode: each read begins with a status byte, which reports when the input of the other end was flushed.
void use_packets(const Pty& pty) {
  const int on = 1;
  ::ioctl(pty.master(), TIOCPKT, &on);
}

}  // namespace

PtyLine::PtyLine(Strand strand, Pty pty, PtyWatch watch)
    : MachineHost(std::move(strand)),
      pty_(std::move(pty)),
      watch_(std::move(watch)),
      bytes_(this->strand(), ::dup(pty_.master())),
      visits_(this->strand(), ::dup(watch_.descriptor())) {
  use_packets(pty_);
}

void PtyLine::start() {
  boost::asio::dispatch(strand(), [self = std::static_pointer_cast<PtyLine>(shared_from_this())] { self->look(); });
}

void PtyLine::shutdown() {
  detach();
  bytes_.close();
  visits_.close();
}

void PtyLine::write(std::string_view bytes) {
  if (!client_ || unsent_.size() + bytes.size() > kBytesUnsentMax) return;
  unsent_ += bytes;
  send();
}

void PtyLine::send() {
  std::size_t sent = 0;
  while (sent < unsent_.size()) {
    const ssize_t size = ::write(pty_.master(), unsent_.data() + sent, unsent_.size() - sent);
    if (size > 0) {
      sent += static_cast<std::size_t>(size);
    } else if (size == 0 || errno != EINTR) {
      break;
    }
  }
  unsent_.erase(0, sent);
  if (!unsent_.empty()) wait_for(bytes_, Stream::wait_write, waiting_for_room_);
}

void PtyLine::reopen(Duration) {
  unsent_.clear();
  pty_.discard_unread();
  forget_flush();
}

// Discards the notice that the machine itself has flushed the other end's input. The notice would come with the next
// bytes and discard their answers. A read of one byte takes the notice and no bytes.
void PtyLine::forget_flush() {
  char changed = TIOCPKT_DATA;
  [[maybe_unused]] const ssize_t size = ::read(pty_.master(), &changed, 1);
}

// Assigns bytes to clients. If several clients followed each other since the last look, the bytes belong to the last
// client if it has written at all. A write is reported after its bytes can be read, so bytes without a report belong to
// the last client, too.
void PtyLine::look() {
  if (!attached()) return;
  PtyWatch::Visits visits{0, wrote_after_reading_, false};
  visits.add(watch_.drain());
  std::string bytes;
  const bool nobody = read_all(bytes);
  const PtyWatch::Visits meanwhile = watch_.drain();
  visits.add(meanwhile);
  wrote_after_reading_ = meanwhile.last_wrote;
  if (visits.came > (client_ ? 0 : 1)) {
    if (visits.others_wrote && !visits.last_wrote) deliver(bytes);
    if (client_) client_left();
  }
  deliver(bytes);
  if (nobody && client_) client_left();
  if (pty_.has_client()) {
    client_came();
  } else if (!client_) {
    watch_.everybody_left();
  }
  send();
  if (client_) wait_for(bytes_, Stream::wait_read, waiting_for_bytes_);
  wait_for(visits_, Stream::wait_read, waiting_for_visits_);
}

// Returns true if no client has the terminal open.
bool PtyLine::read_all(std::string& bytes) {
  std::array<char, 4096> packet;
  for (;;) {
    const ssize_t size = ::read(pty_.master(), packet.data(), packet.size());
    if (size > 0 && packet[0] == TIOCPKT_DATA) {
      bytes.append(packet.data() + 1, static_cast<std::size_t>(size) - 1);
    } else if (size > 0) {
      if ((packet[0] & TIOCPKT_FLUSHREAD) != 0) unsent_.clear();
    } else if (size == 0 || errno != EINTR) {
      return size < 0 && errno == EIO;
    }
  }
}

void PtyLine::deliver(std::string& bytes) {
  if (!bytes.empty()) client_came();
  // Limits the bytes passed at once to what a machine's line buffer takes even if every second byte ends a line.
  constexpr std::size_t kPiece = 1024;
  for (std::string_view rest = bytes; !rest.empty(); rest.remove_prefix(std::min(kPiece, rest.size()))) {
    call([&](LineMachine& machine, TimePoint now) { machine.receive(rest.substr(0, kPiece), now); });
  }
  bytes.clear();
}

void PtyLine::client_came() {
  if (client_) return;
  client_ = true;
  call([](LineMachine& machine, TimePoint now) { machine.link_up(now); });
}

void PtyLine::client_left() {
  client_ = false;
  unsent_.clear();
  if (pty_.has_client()) {
    pty_.discard_unread();
  } else {
    pty_.make_raw();
  }
  forget_flush();
  replace_if_reserved();
  call([](LineMachine& machine, TimePoint now) { machine.link_down(now, "the client closed the line"); });
}

// Replaces a pseudo terminal that a client reserved before it left: nobody could open the terminal any longer, so its
// name then leads to another one.
void PtyLine::replace_if_reserved() {
  if (pty_.has_client()) return;
  const bool reserved = pty_.is_reserved();
  watch_.drain();  // is_reserved() opened the terminal, which is not a visit
  if (!reserved || pty_.has_client()) return;
  auto pty = open_pty(pty_.link());
  if (!pty) return;
  auto watch = PtyWatch::open(*pty);
  if (!watch) return;
  pty_ = std::move(*pty);
  watch_ = std::move(*watch);
  bytes_ = Stream(strand(), ::dup(pty_.master()));
  visits_ = Stream(strand(), ::dup(watch_.descriptor()));
  waiting_for_bytes_ = waiting_for_room_ = waiting_for_visits_ = false;
  use_packets(pty_);
}

void PtyLine::wait_for(Stream& stream, Stream::wait_type what, bool& waiting) {
  if (waiting) return;
  waiting = true;
  stream.async_wait(what, [self = std::static_pointer_cast<PtyLine>(shared_from_this()),
                           &waiting](const boost::system::error_code& error) {
    if (error) return;
    waiting = false;
    self->look();
  });
}

}  // namespace axisgate
