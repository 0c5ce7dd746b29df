// Plays a device behind a pseudo terminal: one client after another, none of which gets its predecessor's bytes.
#pragma once

#include <string>
#include <string_view>

#include "device/link/asio.h"
#include "device/link/machine_host.h"
#include "device/link/pty.h"
#include "device/link/pty_watch.h"

namespace axisgate {

// Made by std::make_shared. The machine receives link_up when a client opens the terminal and link_down when the last
// one has closed it. What it writes waits for the client to read it, and blocks nothing. What it writes while no client
// is there, or when kBytesUnsentMax wait already, is lost. A client that empties its input also empties what waits.
// Threads as for Runner.
class PtyLine : public MachineHost, public ByteLink {
 public:
  static constexpr std::size_t kBytesUnsentMax = 1 << 20;  // beyond what the kernel takes

  PtyLine(Strand strand, Pty pty, PtyWatch watch);

  void start();     // after attach()
  void shutdown();  // on the strand, or when no thread runs its io_context

  void write(std::string_view bytes) override;
  void reopen(Duration wait) override;  // only empties the line: a device cannot make its host open a port

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
