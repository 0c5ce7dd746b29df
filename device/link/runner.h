// Drives one LineMachine over a file descriptor: the thin shell between the sans-I/O core and the operating system.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "device/core/line_machine.h"
#include "device/link/asio.h"
#include "device/link/line_thread.h"
#include "device/link/opener.h"

namespace axisgate {

// Reports whether the device at the other end of this descriptor forbids sending now (serial_port.h). Does not block.
using HeldReader = std::function<bool(int descriptor)>;

// Threads: the overridden members belong to the machine, which calls them from within its own members, on the strand.
// All other members may be called from any thread. The machine runs on the strand only.
// Lifetime: the machine and the io_context must outlive the Runner's last call into the machine. Destroy a Runner on
// its strand, or while no thread runs its io_context; handlers still queued then do nothing.
class Runner : public FlowLink {
 public:
  // Maximum number of bytes that wait for a line that accepts none. With a further byte the line counts as lost.
  static constexpr std::size_t kOutputBytesMax = 64 * 1024;

  // Without an opener, the line comes from adopt() alone; this is the device's end of a line that its host opens.
  // Without a reader, held() is always false.
  explicit Runner(Strand strand, Opener opener = {}, Wakefulness* wakefulness = nullptr, HeldReader held = {});
  ~Runner() override;
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // Attaches the machine. Call once, before start(). `after_call` is called after each call into the machine, when the
  // bytes that it wrote have been sent.
  void attach(LineMachine& machine, std::function<void()> after_call = {});

  // Opens the line. The machine receives link_up, or link_down with the reason. Then, and after every later loss, the
  // machine must call reopen() with its own backoff.
  void start();

  // Closes the line, or abandons opening it, and never calls the machine again. Bytes that a socket still has to send
  // are sent; bytes that a tty's flow control blocks are not. Takes effect at once on the strand, otherwise as soon as
  // the strand is free.
  void shutdown();

  // Replaces the present descriptor. The machine receives link_up.
  void adopt(int descriptor);

  // Runs `request` on the strand, never from within post(). Bytes that the machine wrote in it are then sent, and the
  // machine's deadline is read again. After shutdown() `too_late` is called instead, if given, from any thread.
  void post(std::function<void(TimePoint now)> request, std::function<void()> too_late = {});

  void write(std::string_view bytes) override;
  // Continues an attempt to open the line that is already in progress.
  void reopen(Duration wait) override;
  // Flow control of a tty. For a socket, unsent() counts only bytes that the socket did not take, and held() is always
  // false.
  std::size_t unsent() const override;
  bool held() const override;
  void ignore_flow_control(bool ignored) override;

 private:
  class Line;
  std::shared_ptr<Line> line_;
};

}  // namespace axisgate
