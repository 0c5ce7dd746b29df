// Errors and flags that can be raised on one axis, besides a limit and the emergency stop. Each value is its bit in the
// status.
#pragma once

#include <cstdint>

namespace axisgate::shrc203::simulator {

// Each error stops the axis and clears "normal" (manual 5) Q:S: S1, S2, S4, S3, S7, S10). S9 is an error stop too
// (manual 4) Q:), but no bit reports it.
enum class AxisError { scale = 3, disconnection = 4, overflow = 5, hunting = 7, system = 13, overheat = 15, s9 = 26 };

// The other bits of manual 5), none of which clears "normal". Only the software limits stop the axis.
enum class AxisFlag {
  config = 10,           // auto config error; also reported by ?:ACS (manual 32))
  io_overload = 11,      // W1
  power_overload = 12,   // W2: the 24 V terminal block
  heat = 14,             // W3: motor driver
  out_of_position = 16,  // bit 17 while BUSY
  cw_software_limit = 22,
  ccw_software_limit = 23,
  near_sensor = 24,
};

class StatusBits {
 public:
  template <class Fault>
  void set(Fault fault, bool on) {
    bits_ = on ? bits_ | bit(fault) : bits_ & ~bit(fault);
  }
  template <class Fault>
  bool has(Fault fault) const {
    return (bits_ & bit(fault)) != 0;
  }
  bool any() const { return bits_ != 0; }
  std::uint32_t raw() const { return bits_; }

 private:
  template <class Fault>
  static std::uint32_t bit(Fault fault) {
    return 1u << (static_cast<int>(fault) - 1);
  }
  std::uint32_t bits_ = 0;
};

}  // namespace axisgate::shrc203::simulator
