#include "device/rml1/simulator/spindle.h"

#include <algorithm>
#include <utility>

namespace axisgate::rml1::simulator {
namespace {

constexpr double kStageMax = 15, kFirstRpm = 100;  // guideline 3-3 !RC

}  // namespace

void SpindleMotor::forbid() {
  permitted_ = false;
  stop();
}

bool SpindleMotor::start() {
  if (!permitted_ || std::exchange(rotates_, true)) return false;
  record_.spindle(rpm());
  return true;
}

void SpindleMotor::stop() {
  if (std::exchange(rotates_, false)) record_.spindle(0);
}

void SpindleMotor::set_revolutions(double parameter) {
  if (data_.law == Spindle::Law::fixed) return;
  parameter_ = parameter;
  if (rotates_) record_.spindle(rpm());
}

void SpindleMotor::switch_off() {
  stop();
  permitted_ = true;
  parameter_ = 0;
}

double SpindleMotor::rpm() const { return rotates_ ? set_rpm() : 0; }

double SpindleMotor::set_rpm() const {
  if (data_.law == Spindle::Law::fixed) return data_.maximum_rpm;
  const bool direct = data_.law == Spindle::Law::direct && parameter_ >= kFirstRpm;
  const double lowest = data_.stage_0_rpm.value_or(data_.minimum_rpm);
  const double stage = data_.rpm_per_stage.value_or((data_.maximum_rpm - data_.minimum_rpm) / kStageMax);
  const double wanted = direct ? parameter_ : lowest + stage * std::min(parameter_, kStageMax);
  return std::clamp(wanted, data_.minimum_rpm, data_.maximum_rpm);
}

}  // namespace axisgate::rml1::simulator
