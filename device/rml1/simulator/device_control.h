// Removes ESC sequences from the bytes before the buffer (guideline 4-1).
#pragma once

namespace axisgate::rml1::simulator {

class DeviceControlSink {
 public:
  virtual ~DeviceControlSink() = default;
  virtual void data(char byte) = 0;
  virtual void escape_k() = 0;
  virtual void line_error(int number) = 0;
};

class DeviceControl {
 public:
  explicit DeviceControl(DeviceControlSink& sink) : sink_(sink) {}

  void take(char byte);
  void forget() { state_ = State::data; }

 private:
  enum class State { data, after_escape, after_point };

  DeviceControlSink& sink_;
  State state_ = State::data;
};

}  // namespace axisgate::rml1::simulator
