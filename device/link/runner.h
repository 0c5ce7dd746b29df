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

// Whether the device at the other end of this descriptor forbids sending now (serial_port.h). Does not block.
using HeldReader = std::function<bool(int descriptor)>;

// Threads: what it overrides belongs to the machine, which calls it from within its own members, on the strand.
// Everything else may be called from any thread. The machine is only ever called on the strand.
// Lifetime: the machine and the io_context outlive the Runner's last call into the machine. Destroy a Runner on its
// strand or when no thread runs its io_context any more; handlers still queued then do nothing.
class Runner : public FlowLink {
 public:
  // Bytes that may wait for a line that takes none. One more, and the line counts as lost.
  static constexpr std::size_t kOutputBytesMax = 64 * 1024;

  // Without an opener the line comes from adopt() alone: the device's end of a line that its host opens.
  // Without a reader the line is never held.
  explicit Runner(Strand strand, Opener opener = {}, Wakefulness* wakefulness = nullptr, HeldReader held = {});
  ~Runner() override;
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // Before start(), once. `after_call` is called behind each call into the machine, when what it wrote has been sent.
  void attach(LineMachine& machine, std::function<void()> after_call = {});

  // Opens the line. The machine receives link_up, or link_down with the reason. Then, and after every later loss, the
  // machine must call reopen() with its own backoff.
  void start();

  // Closes the line, or abandons opening it, and never calls the machine again. What a socket still has to send is
  // sent; what a tty's flow control holds back is not. Takes effect at once on the strand, otherwise as soon as the
  // strand is free.
  void shutdown();

  // Takes over a descriptor in place of the present one. The machine receives link_up.
  void adopt(int descriptor);

  // Runs `request` on the strand, never from within post(). Afterwards what it made the machine write is sent, and the
  // machine's deadline is looked at again. After shutdown() `too_late` is called in its place, if there is one, from
  // any thread.
  void post(std::function<void(TimePoint now)> request, std::function<void()> too_late = {});

  void write(std::string_view bytes) override;
  // While the line is already being opened, that attempt continues.
  void reopen(Duration wait) override;
  // Of a tty. A socket's are in the hands of its other end: nothing unsent beyond what it did not take, and never held.
  std::size_t unsent() const override;
  bool held() const override;
  void ignore_flow_control(bool ignored) override;

 private:
  class Line;
  std::shared_ptr<Line> line_;
};

}  // namespace axisgate
