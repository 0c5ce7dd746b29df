// How long one straight movement takes, and how far it has come: from standstill to standstill.
#pragma once

namespace axisgate::rml1::simulator {

struct Travel {
  double mm = 0;
  double mm_per_s = 0;
  double mm_per_s2 = 0;  // 0: the speed is there at once
  double slower = 1;     // the time is multiplied by this

  double seconds() const;
  double part_after(double seconds) const;  // 0 to 1
};

}  // namespace axisgate::rml1::simulator
