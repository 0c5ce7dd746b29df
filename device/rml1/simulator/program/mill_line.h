// Reads what the host sends, as fast as a line of some baud rate brings it, and not at all while the mill holds it
// back.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "device/link/machine_host.h"
#include "device/rml1/simulator/program/host_end.h"

namespace axisgate::rml1::simulator {

// What the kernel has taken from the host and this has not read counts as not sent yet. Made by std::make_shared; all
// members on the strand, or when no thread runs its io_context.
class MillLine : public MachineHost, public ByteLink {
 public:
  static constexpr std::size_t kBytesMax = 4096;  // at once

  // `bytes_at_once`: so many may still come after the mill has stopped its host.
  MillLine(Strand strand, std::unique_ptr<HostEnd> end, Duration byte_time, std::size_t bytes_at_once);

  // After attach(). `is_held_back` is whether the host sends nothing now, because of the mill.
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
  bool held_ = false;  // no bytes are awaited: the mill holds the host back
};

}  // namespace axisgate::rml1::simulator
