// Duration and progress of one straight movement from standstill to standstill.
#pragma once

namespace axisgate::rml1::simulator {

struct Travel {
  double mm = 0;
  double mm_per_s = 0;
  double mm_per_s2 = 0;  // 0: the speed is reached at once
  double slower = 1;     // factor of the time

  double seconds() const;
  double part_after(double seconds) const;  // 0 to 1
};

}  // namespace axisgate::rml1::simulator
