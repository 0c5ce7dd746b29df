#include "device/link/pty_line.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <utility>

namespace axisgate {

PtyLine::PtyLine(Strand strand, Pty pty, PtyWatch watch)
    : MachineHost(std::move(strand)),
      pty_(std::move(pty)),
      watch_(std::move(watch)),
      bytes_(this->strand(), ::dup(pty_.master())),
      visits_(this->strand(), ::dup(watch_.descriptor())) {}

void PtyLine::start() {
  boost::asio::dispatch(strand(), [self = std::static_pointer_cast<PtyLine>(shared_from_this())] { self->look(); });
}

void PtyLine::shutdown() {
  detach();
  bytes_.close();
  visits_.close();
}

void PtyLine::write(std::string_view bytes) {
  while (client_ && !bytes.empty()) {
    const ssize_t sent = ::write(pty_.master(), bytes.data(), bytes.size());
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (sent == 0 || errno != EINTR) {
      return;
    }
  }
}

void PtyLine::reopen(Duration) { pty_.discard_unread(); }

// Bytes are read before the visits, so that the coming of every client whose bytes were read is among the visits. Where
// clients followed each other since the last look, the bytes are the last one's if it has written at all.
void PtyLine::look() {
  if (!attached()) return;
  std::string bytes;
  const bool nobody = read_all(bytes);
  const PtyWatch::Visits visits = watch_.drain();
  if (visits.came > (client_ ? 0 : 1)) {
    if (!visits.last_wrote) deliver(bytes);
    if (client_) client_left();
  }
  deliver(bytes);
  if (nobody && client_) client_left();
  if (pty_.has_client()) {
    client_came();
  } else if (!client_) {
    watch_.everybody_left();
  }
  if (client_) wait_for(bytes_, waiting_for_bytes_);
  wait_for(visits_, waiting_for_visits_);
}

// True when no client has the terminal open.
bool PtyLine::read_all(std::string& bytes) {
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t size = ::read(pty_.master(), buffer.data(), buffer.size());
    if (size > 0) {
      bytes.append(buffer.data(), static_cast<std::size_t>(size));
    } else if (size == 0 || errno != EINTR) {
      return size < 0 && errno == EIO;
    }
  }
}

void PtyLine::deliver(std::string& bytes) {
  if (!bytes.empty()) client_came();
  // No more at once than a machine's line buffer takes even if every second byte ends a line.
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
  if (pty_.has_client()) {
    pty_.discard_unread();
  } else {
    pty_.make_raw();
  }
  call([](LineMachine& machine, TimePoint now) { machine.link_down(now, "the client closed the line"); });
}

void PtyLine::wait_for(Stream& stream, bool& waiting) {
  if (waiting) return;
  waiting = true;
  stream.async_wait(Stream::wait_read, [self = std::static_pointer_cast<PtyLine>(shared_from_this()),
                                        &waiting](const boost::system::error_code& error) {
    waiting = false;
    if (!error) self->look();
  });
}

}  // namespace axisgate
