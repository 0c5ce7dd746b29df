// Interpretations of places where the guideline is silent or ambiguous: README.md names each place.
#pragma once

#include <cstddef>

#include "device/core/named_options.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1::simulator {

class Options : public NamedOptions {
 public:
  Options();
};

std::span<const OptionName> option_names();

// Method by which the mill stops its host.
enum class Flow { none, xon, rts };

struct MillSetup {
  Profile profile;
  Options options;
  std::size_t buffer_bytes = 1024;  // 16 to 1048576
  Flow flow = Flow::none;
  double slower_percent = 0;  // 0 to 1000: percent by which each motion takes longer than by the profile
};

}  // namespace axisgate::rml1::simulator
