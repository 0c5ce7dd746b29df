#include "device/rml1/simulator/device_control.h"

#include <utility>

namespace axisgate::rml1::simulator {
namespace {

constexpr char kEscape = 0x1B;
constexpr int kUnsupported = 11;  // guideline 4-1, error list

}  // namespace

void DeviceControl::take(char byte) {
  switch (std::exchange(state_, State::data)) {
    case State::data:
      if (byte == kEscape) {
        state_ = State::after_escape;
      } else {
        sink_.data(byte);
      }
      return;
    case State::after_escape:
      if (byte == '.') {
        state_ = State::after_point;
        return;
      }
      // ESC without a point begins no sequence: "the order of characters appearing in the sequence is passed
      // unchanged".
      sink_.data(kEscape);
      take(byte);
      return;
    case State::after_point:
      if (byte == 'K') return sink_.escape_k();
      sink_.line_error(kUnsupported);
      sink_.data(byte);
      return;
  }
}

}  // namespace axisgate::rml1::simulator
