// Plays a device on a pseudo terminal for one client after another; no client receives bytes meant for the previous
// one.
#pragma once

#include <string>
#include <string_view>

#include "device/link/asio.h"
#include "device/link/machine_host.h"
#include "device/link/pty.h"
#include "device/link/pty_watch.h"

namespace axisgate {

// A PtyLine must be made by std::make_shared. The machine receives link_up when a client opens the terminal, and
// link_down when the last client has closed it. Bytes that the machine writes wait for the client to read them, and
// block nothing. Bytes that it writes while no client is there, or while kBytesUnsentMax wait already, are lost. A
// client that flushes its input also discards the waiting bytes. The rules for threads are those of Runner.
class PtyLine : public MachineHost, public ByteLink {
 public:
  static constexpr std::size_t kBytesUnsentMax = 1 << 20;  // in addition to what the kernel takes

  PtyLine(Strand strand, Pty pty, PtyWatch watch);

  void start();     // call after attach()
  void shutdown();  // call on the strand, or while no thread runs its io_context

  void write(std::string_view bytes) override;
  void reopen(Duration wait) override;  // only discards queued bytes: a device cannot make its host open a port

  const Pty& pty() const { return pty_; }

 private:
  using Stream = boost::asio::posix::stream_descriptor;

  void settle() override {}
  void look();
  bool read_all(std::string& bytes);
  void deliver(std::string& bytes);
  void client_came();
  void client_left();
  void forget_flush();
  void replace_if_reserved();
  void send();
  void wait_for(Stream& stream, Stream::wait_type what, bool& waiting);

  Pty pty_;
  PtyWatch watch_;
  Stream bytes_;
  Stream visits_;
  std::string unsent_;
  bool waiting_for_bytes_ = false;
  bool waiting_for_room_ = false;
  bool waiting_for_visits_ = false;
  bool client_ = false;
  bool wrote_after_reading_ = false;
};

}  // namespace axisgate
