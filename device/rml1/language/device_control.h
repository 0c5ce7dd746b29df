// ESC sequences are taken out of the bytes before anybody reads them as a job (guideline 4-1).
#pragma once

#include <cstdint>

namespace axisgate::rml1 {

// ESC . K is a sequence; ESC . and something else is none: ESC and the point are discarded, and that byte is data. ESC
// and something other than a point are both data.
class DeviceControl {
 public:
  enum class Found : std::uint8_t {
    data,     // the byte itself
    held,     // nothing yet
    escape,   // an ESC that began no sequence, and then look at the byte again
    quit,     // ESC.K is complete: the byte belonged to it
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

  // At the end of a job: whether a sequence has begun.
  bool cut_off() const { return state_ == State::point; }

  static constexpr char kEscape = '\x1B';

 private:
  enum class State : std::uint8_t { idle, escape, point };
  State state_ = State::idle;
};

}  // namespace axisgate::rml1
