// Removes ESC sequences from the bytes before they are read as a job (guideline 4-1).
#pragma once

#include <cstdint>

namespace axisgate::rml1 {

// ESC . K is a sequence. After ESC . any other byte is data, and ESC and the point are discarded. If another byte than
// a point follows ESC, both are data.
class DeviceControl {
 public:
  enum class Found : std::uint8_t {
    data,     // the byte itself is data
    held,     // no decision yet
    escape,   // the ESC began no sequence and is data; the byte must be taken again
    quit,     // the byte completes ESC.K
    unknown,  // error 11; the byte is data
  };

  bool idle() const { return state_ == State::idle; }

  Found take(char c) {
    switch (state_) {
      case State::idle:
        if (c != kEscape) return Found::data;
        state_ = State::escape;
        return Found::held;
      case State::escape:
        state_ = c == '.' ? State::point : State::idle;
        return c == '.' ? Found::held : Found::escape;
      case State::point:
        break;
    }
    state_ = State::idle;
    return c == 'K' ? Found::quit : Found::unknown;
  }

  // Reports whether a job that ends here ends within a sequence.
  bool cut_off() const { return state_ == State::point; }

  static constexpr char kEscape = '\x1B';

 private:
  enum class State : std::uint8_t { idle, escape, point };
  State state_ = State::idle;
};

}  // namespace axisgate::rml1
