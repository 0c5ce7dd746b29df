// Reads the bytes of the host at the speed of a line with some baud rate, and stops while the mill stops its host.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "device/link/machine_host.h"
#include "device/rml1/simulator/program/host_end.h"

namespace axisgate::rml1::simulator {

// Bytes that the kernel has taken from the host and this object has not read count as not sent. Must be made by
// std::make_shared. All members must be called on the strand, or while no thread runs its io_context.
class MillLine : public MachineHost, public ByteLink {
 public:
  static constexpr std::size_t kBytesMax = 4096;  // at once

  // `bytes_at_once`: maximum number of bytes that may still come after the mill has stopped its host.
  MillLine(Strand strand, std::unique_ptr<HostEnd> end, Duration byte_time, std::size_t bytes_at_once);

  // Call after attach(). `is_held_back` reports whether the mill keeps the host from sending.
  void start(std::function<bool()> is_held_back);
  void shutdown();

  void write(std::string_view bytes) override { end_->write(bytes); }
  void reopen(Duration) override {}  // a mill cannot make its host open a port

  const HostEnd& end() const { return *end_; }

 private:
  void settle() override;
  void look();
  void look_later(Duration time);
  void await_bytes();

  std::unique_ptr<HostEnd> end_;
  Duration byte_time_;
  std::size_t bytes_at_once_;
  std::function<bool()> is_held_back_;
  boost::asio::steady_timer pace_;
  TimePoint line_free_{};
  bool held_ = false;  // the mill has stopped its host, so no bytes are awaited
};

}  // namespace axisgate::rml1::simulator
