#include "device/link/runner.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "device/link/clock.h"
#include "device/link/descriptor.h"
#include "device/link/machine_host.h"

namespace axisgate {

using boost::system::error_code;

// Line of a Runner. A handler of a closed descriptor may still be queued when the next descriptor is open: it carries
// the generation in which it was started, and does nothing if the generation has changed.
class Runner::Line : public MachineHost {
 public:
  Line(Strand strand, Opener opener, Wakefulness* wakefulness, HeldReader held)
      : MachineHost(std::move(strand)),
        opener_(std::move(opener)),
        wakefulness_(wakefulness),
        held_(std::move(held)),
        descriptor_(this->strand()),
        reopen_timer_(this->strand()) {}

  void attach(LineMachine& machine, std::function<void()> after_call);
  void open();
  void adopt(Descriptor opened);
  void shut();
  void write(std::string_view bytes);
  void reopen(Duration wait);
  std::size_t unsent() const;
  bool held() const;
  void ignore_flow_control(bool ignored);

 private:
  std::shared_ptr<Line> self() { return std::static_pointer_cast<Line>(shared_from_this()); }
  void settle() override;
  // Casts const away, because Asio's native_handle() is not const.
  int fd() const { return const_cast<boost::asio::posix::stream_descriptor&>(descriptor_).native_handle(); }
  bool answers() const;
  void start_reading();
  void await_loss();
  void on_read(const error_code& error, std::size_t count);
  void send_queued();
  void wait_for_room();
  void lose(std::string_view why);
  void close();
  void discard_unsent();

  std::function<void()> after_call_;
  Opener opener_;
  Wakefulness* const wakefulness_;
  const HeldReader held_;
  Opening opening_;
  boost::asio::posix::stream_descriptor descriptor_;
  boost::asio::steady_timer reopen_timer_;
  std::uint64_t generation_ = 0;
  std::array<char, 4096> incoming_{};
  std::string queued_;
  bool socket_ = false;
  bool waiting_for_room_ = false;
  bool overflowed_ = false;
  std::optional<termios> respecting_;  // the tty's original mode, while flow control is ignored
};

void Runner::Line::attach(LineMachine& machine, std::function<void()> after_call) {
  after_call_ = std::move(after_call);
  MachineHost::attach(machine);
}

void Runner::Line::open() {
  if (!attached() || !opener_ || opening_) return;
  opening_ = opener_(strand(), [this](OpenedLine opened) {
    opening_.reset();
    if (opened) return adopt(std::move(*opened));
    const Problem& problem = opened.error();
    lose(problem.hint.empty() ? problem.message : problem.message + ". " + problem.hint);
  });
}

void Runner::Line::adopt(Descriptor opened) {
  if (!attached()) return;
  close();
  error_code error;
  descriptor_.assign(opened.get(), error);
  if (error) return lose("the line cannot be waited for: " + error.message());
  struct stat status {};
  socket_ = ::fstat(opened.release(), &status) == 0 && S_ISSOCK(status.st_mode);
  const auto generation = generation_;
  call([](LineMachine& machine, TimePoint now) { machine.link_up(now); });
  if (generation == generation_) answers() ? start_reading() : await_loss();
}

void Runner::Line::shut() {
  detach();
  opener_ = {};
  close();
}

// Discards unsent bytes before closing: a command must not reach a device later, when its caller no longer waits for
// the answer. Closing a tty with bytes that flow control blocks would also wait for as long as its driver does. Bytes
// that have left the driver are not discarded: a flush might recall them, for instance from a USB converter, or from a
// pseudo-terminal whose reader has not read them. After shutdown, a socket may still send.
void Runner::Line::discard_unsent() {
  const int line = descriptor_.native_handle();
  const linger none{.l_onoff = 1, .l_linger = 0};
  if (!socket_) {
    ::tcflush(line, unsent() > 0 ? TCIOFLUSH : TCIFLUSH);
  } else if (attached()) {
    ::setsockopt(line, SOL_SOCKET, SO_LINGER, &none, sizeof none);
  }
}

void Runner::Line::close() {
  ++generation_;
  opening_.reset();
  error_code ignored;
  if (descriptor_.is_open()) discard_unsent();
  descriptor_.close(ignored);
  reopen_timer_.cancel();
  queued_.clear();
  waiting_for_room_ = false;
  overflowed_ = false;
  respecting_.reset();
}

void Runner::Line::lose(std::string_view why) {
  close();
  call([&](LineMachine& machine, TimePoint now) { machine.link_down(now, why); });
}

void Runner::Line::write(std::string_view bytes) {
  if (!descriptor_.is_open()) return;
  if (queued_.size() + bytes.size() > kOutputBytesMax) {
    overflowed_ = true;  // reported to the machine after it has returned
    return;
  }
  queued_ += bytes;
}

void Runner::Line::reopen(Duration wait) {
  if (opening_) return;
  close();
  reopen_timer_.expires_after(wait);
  reopen_timer_.async_wait([self = self(), generation = generation_](const error_code& error) {
    if (!error && generation == self->generation_) self->open();
  });
}

std::size_t Runner::Line::unsent() const {
  int in_driver = 0;
  const bool known = descriptor_.is_open() && !socket_ && ::ioctl(fd(), TIOCOUTQ, &in_driver) == 0;
  return queued_.size() + (known ? static_cast<std::size_t>(in_driver) : 0);
}

bool Runner::Line::held() const { return descriptor_.is_open() && !respecting_ && held_ && held_(fd()); }

// Changes the mode at once: an output that an XOFF has stopped continues without IXON, while tcflow() does not undo an
// XOFF.
void Runner::Line::ignore_flow_control(bool ignored) {
  if (ignored == respecting_.has_value()) return;
  termios mode{};
  if (!ignored) {
    mode = *std::exchange(respecting_, {});
  } else if (descriptor_.is_open() && ::tcgetattr(fd(), &mode) == 0) {
    respecting_ = mode;
    mode.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS);
    mode.c_iflag &= ~static_cast<tcflag_t>(IXON);
  } else {
    return;
  }
  ::tcsetattr(fd(), TCSANOW, &mode);
}

void Runner::Line::settle() {
  if (overflowed_) return lose("the line takes no bytes: its output queue is full");
  send_queued();
  if (attached() && after_call_) after_call_();
}

// Reports whether the line can be read: a printer device is open for writing alone.
bool Runner::Line::answers() const { return (::fcntl(fd(), F_GETFL) & O_ACCMODE) != O_WRONLY; }

// Waits for a loss that a line reports even though it is neither read nor written.
void Runner::Line::await_loss() {
  descriptor_.async_wait(boost::asio::posix::stream_descriptor::wait_error,
                         [self = self(), generation = generation_](const error_code& error) {
                           if (!error && generation == self->generation_) {
                             self->lose("the line was closed at its other end");
                           }
                         });
}

void Runner::Line::start_reading() {
  descriptor_.async_read_some(boost::asio::buffer(incoming_),
                              [self = self(), generation = generation_](const error_code& error, std::size_t count) {
                                if (generation == self->generation_) self->on_read(error, count);
                              });
}

void Runner::Line::on_read(const error_code& error, std::size_t count) {
  if (error == boost::asio::error::eof) return lose("the line was closed at its other end");
  if (error) return lose("reading from the line failed: " + error.message());
  if (wakefulness_ != nullptr) wakefulness_->replied(monotonic_now());
  const auto generation = generation_;
  call([&](LineMachine& machine, TimePoint now) { machine.receive({incoming_.data(), count}, now); });
  if (generation == generation_) start_reading();
}

void Runner::Line::send_queued() {
  while (!queued_.empty() && !waiting_for_room_) {
    // A socket whose other end is gone must return EPIPE, not end the process by SIGPIPE.
    const int line = descriptor_.native_handle();
    const ssize_t sent = socket_ ? ::send(line, queued_.data(), queued_.size(), MSG_NOSIGNAL)
                                 : ::write(line, queued_.data(), queued_.size());
    if (sent >= 0) {
      queued_.erase(0, static_cast<std::size_t>(sent));
      if (wakefulness_ != nullptr) wakefulness_->written(monotonic_now());
    } else if (errno == EAGAIN) {
      wait_for_room();
    } else if (errno != EINTR) {
      return lose("writing to the line failed: " + std::generic_category().message(errno));
    }
  }
}

void Runner::Line::wait_for_room() {
  waiting_for_room_ = true;
  descriptor_.async_wait(boost::asio::posix::stream_descriptor::wait_write,
                         [self = self(), generation = generation_](const error_code&) {
                           if (generation != self->generation_) return;
                           self->waiting_for_room_ = false;
                           self->send_queued();
                         });
}

Runner::Runner(Strand strand, Opener opener, Wakefulness* wakefulness, HeldReader held)
    : line_(std::make_shared<Line>(std::move(strand), std::move(opener), wakefulness, std::move(held))) {}

Runner::~Runner() { line_->shut(); }

void Runner::attach(LineMachine& machine, std::function<void()> after_call) {
  line_->attach(machine, std::move(after_call));
}

void Runner::start() {
  boost::asio::dispatch(line_->strand(), [line = line_] { line->open(); });
}

void Runner::shutdown() {
  boost::asio::dispatch(line_->strand(), [line = line_] { line->shut(); });
}

void Runner::adopt(int descriptor) {
  boost::asio::dispatch(line_->strand(),
                        [line = line_, opened = Descriptor(descriptor)]() mutable { line->adopt(std::move(opened)); });
}

void Runner::post(std::function<void(TimePoint now)> request, std::function<void()> too_late) {
  line_->post(std::move(request), std::move(too_late));
}

void Runner::write(std::string_view bytes) { line_->write(bytes); }

void Runner::reopen(Duration wait) { line_->reopen(wait); }

std::size_t Runner::unsent() const { return line_->unsent(); }

bool Runner::held() const { return line_->held(); }

void Runner::ignore_flow_control(bool ignored) { line_->ignore_flow_control(ignored); }

}  // namespace axisgate
