// Simulates a real line to a device: bytes take time, replies are delayed, and the device's own time may run faster.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/line_machine.h"

namespace axisgate {

struct Pacing {
  int baud = 0;            // bits a second, ten a byte; 0 passes bytes at once
  Duration reply_delay{};  // added to all bytes that the device writes
  double speed = 1;        // factor by which the device's time runs faster than the shell's; above 0
};

// Wraps a device: it acts as the machine for the shell, and as the line for the device. Baud and delay are in the
// shell's time. Not thread safe. When the line goes down, written bytes still reach the device, but its answers are
// lost.
class PacedLine : public LineMachine {
 public:
  // Maximum number of bytes in transit in each direction. Further bytes are lost, as on a line without handshake.
  static constexpr std::size_t kBytesUnderWayMax = 1 << 20;

  using Factory = std::function<std::unique_ptr<LineMachine>(ByteLink& line)>;

  PacedLine(Pacing pacing, ByteLink& outside, const Factory& make_device);
  ~PacedLine() override;

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

  // Acts on the device without using its line; `act` receives the device's own time.
  void touch(TimePoint now, const std::function<void(TimePoint device_now)>& act);

 private:
  class DeviceSide;

  // One direction of the line: the bytes in transit, and when each arrives.
  class Way {
   public:
    void send(std::string_view bytes, TimePoint from, Duration byte_time);
    std::string arrived_by(TimePoint time);
    std::optional<TimePoint> next_arrival() const;
    void drop(TimePoint now);

   private:
    struct Byte {
      char value;
      TimePoint due;
    };
    std::deque<Byte> bytes_;
    TimePoint free_{};
  };

  Duration byte_time() const;
  TimePoint device_time(TimePoint shell) const;
  TimePoint shell_time(TimePoint device) const;
  void run_device_to(TimePoint shell);
  void from_device(std::string_view bytes);
  void step(TimePoint until);
  void write_due(TimePoint until);
  void drop_bytes();

  Pacing pacing_;
  ByteLink& outside_;
  std::unique_ptr<DeviceSide> device_side_;
  std::unique_ptr<LineMachine> device_;
  std::optional<TimePoint> origin_;  // time at which both clocks are equal
  TimePoint shell_now_{};
  TimePoint device_now_{};
  Way inward_, outward_;
};

}  // namespace axisgate
