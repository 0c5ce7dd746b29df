// The spindle motor (guideline 3-3 !MC and !RC, 5-2).
#pragma once

#include "device/rml1/machine/profile.h"
#include "device/rml1/simulator/record.h"

namespace axisgate::rml1::simulator {

class SpindleMotor {
 public:
  // The referenced objects must outlive this one.
  SpindleMotor(const Spindle& data, Record& record) : data_(data), record_(record) {}

  void permit() { permitted_ = true; }
  void forbid();
  // Starts the motor if it is permitted and stopped. Returns true if it was started, so that movement must wait for the
  // spin-up.
  bool start();
  void stop();
  void set_revolutions(double parameter);  // parameter of !RC, 0 to 8388607
  void switch_off();                       // all settings are lost, as when the mill is switched off

  bool rotates() const { return rotates_; }
  double rpm() const;  // speed that is set; 0 while stopped

 private:
  double set_rpm() const;

  const Spindle& data_;
  Record& record_;
  bool permitted_ = true;
  bool rotates_ = false;
  double parameter_ = 0;
};

}  // namespace axisgate::rml1::simulator
