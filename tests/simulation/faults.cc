// Fault profiles of a line and its device.
#include "tests/simulation/wire.h"

namespace axisgate::simulation {

Faults Faults::mild() {
  Faults f;
  f.drop_reply = f.drop_notice = f.late_reply = f.late_notice = 0.001;
  f.split = 0.01;
  f.mishaps_an_hour = 1;
  return f;
}

Faults Faults::rough() {
  Faults f = mild();
  f.drop_command = f.drop_reply = f.late_reply = 0.005;
  f.double_notice = f.drop_notice = f.late_notice = 0.02;
  f.noise = f.flip_reply = 0.001;
  f.lose_byte = f.double_byte = f.eight_bit = f.merge = 0.0005;
  f.mishaps_an_hour = 5;
  return f;
}

Faults Faults::hostile() {
  Faults f;
  f.drop_command = f.drop_reply = 0.01;
  f.flip_command = f.null_in_command = 0.002;
  f.late_reply = 0.01;
  f.double_reply = 0.01;
  f.false_ng = 0.002;
  f.flip_reply = 0.005;
  f.noise = 0.005;
  f.split = 0.02;
  f.drop_notice = f.late_notice = f.double_notice = 0.05;
  f.flood_notice = 0.01;
  f.flip_notice = 0.01;
  f.reorder_notice = 0.1;
  f.lose_byte = f.double_byte = f.eight_bit = f.merge = 0.002;
  f.mishaps_an_hour = 30;
  return f;
}

std::optional<Faults> Faults::named(std::string_view profile) {
  if (profile == "quiet") return none();
  if (profile == "mild") return mild();
  if (profile == "rough") return rough();
  if (profile == "hostile") return hostile();
  return {};
}

}  // namespace axisgate::simulation
